// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/bake/recipe_text.h"
#include "woodcock/bake/ax_expression.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace bake;

namespace {

constexpr const char* ball = R"(
[node.ball]
type = "falloff"
edge = 0.5
profile = "linear"
input = { type = "sphere", radius = 1.5 }
)";

openvdb::FloatGrid::Ptr bake(const Recipe& recipe) {
    return openvdb::gridPtrCast<openvdb::FloatGrid>(
        bakeRecipe(recipe, cubicVoxels(0.1))->grids->grids[0]);
}

std::string code(const std::string& text) { return "code = \"\"\"\n" + text + "\"\"\"\n"; }

TEST(AxNode, ChangesWhatItsInputSays) {
    if (!axAvailable()) GTEST_SKIP() << "this build has no OpenVDB AX";
    const auto plain = bake(recipeOf(ball, "ball"));
    const auto changed =
        bake(recipeOf(ball +
                      std::string("[node.thing]\ntype = \"ax\"\ninput = \"ball\"\n"
                                  "with = { x = { type = \"position\", of = \"x\" } }\n") +
                      code("if (@x > 0) @density *= 0.5f;")));
    EXPECT_EQ(plain->activeVoxelCount(), changed->activeVoxelCount());
    const auto accessor = changed->getConstAccessor();
    for (auto v = plain->cbeginValueOn(); v; ++v) {
        openvdb::CoordBBox box;
        v.getBoundingBox(box);
        for (auto c = box.begin(); c; ++c)
            ASSERT_EQ(accessor.getValue(*c), (*c).x() > 0 ? *v * 0.5f : *v) << *c;
    }
}

// What is made of its values goes on from there, at moved points too.
TEST(AxNode, FeedsOtherNodes) {
    if (!axAvailable()) GTEST_SKIP() << "this build has no OpenVDB AX";
    const auto moved = bake(recipeOf(
        ball + std::string("[node.twice]\ntype = \"ax\"\ninput = \"ball\"\nname = \"d\"\n") +
        code("@d = 2 * @d;") +
        "[node.moved]\ntype = \"transform\"\ntranslate = [0.3, 0, 0]\ninput = \"twice\"\n"
        "[node.thing]\ntype = \"multiply\"\ninputs = [\"moved\", 3]\n"));
    const auto accessor = moved->getConstAccessor();
    EXPECT_EQ(accessor.getValue({3, 0, 0}), 6);  // the ball's centre
    EXPECT_NEAR(accessor.getValue({16, 0, 0}), 6 * 0.4, 1e-5);
}

TEST(AxNode, MistakesNameThePlaceInTheRecipe) {
    if (!axAvailable()) GTEST_SKIP() << "this build has no OpenVDB AX";
    try {
        recipeOf(ball + std::string("[node.thing]\ntype = \"ax\"\ninput = \"ball\"\n") +
                 code("@density = nosuch(1);"));
        FAIL() << "no error";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("test.toml:13:8: AX 1:"), std::string::npos)
            << e.what();
        EXPECT_NE(std::string(e.what()).find("nosuch"), std::string::npos) << e.what();
    }
}

TEST(AxNode, CountsWhatIsNotFinite) {
    if (!axAvailable()) GTEST_SKIP() << "this build has no OpenVDB AX";
    try {
        bake(recipeOf(ball + std::string("[node.thing]\ntype = \"ax\"\ninput = \"ball\"\n") +
                      code("@density = log(-1.0f);")));
        FAIL() << "no error";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("not finite at "), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace woodcock::test
