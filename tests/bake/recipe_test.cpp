// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/recipe.h"

#include <gtest/gtest.h>

#include "tests/bake/recipe_text.h"
#include "woodcock/bake/node_reader.h"

namespace woodcock::test {

using namespace bake;

namespace {

constexpr const char* bounds = "[bounds]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n";
constexpr const char* output = "[[output]]\nname = \"density\"\nnode = \"ball\"\n";
constexpr const char* ball = "[node.ball]\ntype = \"sphere\"\nradius = 0.5\n";

Recipe make(const std::string& text, const std::vector<ParameterSetting>& set = {}) {
    return makeRecipe({text, "r.toml", ""}, set);
}

/// What a recipe is refused with.
std::string mistake(const std::string& text, const std::vector<ParameterSetting>& set = {}) {
    try {
        make(text, set);
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

double at(const Recipe& recipe, Vec3d p) { return evaluateRecipe(recipe, 0, {p})[0].x; }

TEST(Recipe, ExpressionsOfParameters) {
    const std::string text =
        "[parameters]\nsize = { default = 3, range = [1, 9] }\n[let]\nhalf = \"double / 4\"\n"
        "double = \"2 * size\"\n" +
        std::string(bounds) + "[node.ball]\ntype = \"sphere\"\nradius = \"half + sqrt(4)\"\n" +
        output;
    EXPECT_DOUBLE_EQ(at(make(text), {}), -3.5);
    EXPECT_DOUBLE_EQ(at(make(text, {{"size", 5, "--set size=5"}}), {}), -4.5);
}

TEST(Recipe, NodesMayBeWrittenInPlace) {
    const Recipe recipe = recipeOf(
        "[node.thing]\ntype = \"add\"\ninputs = [1, { type = \"position\", of = \"x\" }, \"y\"]\n"
        "[node.y]\ntype = \"position\"\nof = \"y\"");
    EXPECT_DOUBLE_EQ(at(recipe, {0.25, 0.5, 9}), 1.75);
}

TEST(Recipe, MistakesAreNamedWithTheirPlace) {
    const auto expect = [](const std::string& text, const std::string& part) {
        EXPECT_NE(mistake(text).find(part), std::string::npos) << mistake(text);
    };
    const std::string b = bounds, o = output, n = ball;
    expect(b + o, "r.toml:6:8: output[0].node is not a node: 'ball'");
    expect(b + "[node.bal]\ntype = \"sphere\"\nradius = 1\n" + o, "did you mean 'bal'");
    expect(b + "[node.ball]\ntype = \"spere\"\n" + o, "'spere'");
    expect(b + "[node.ball]\ntype = \"spere\"\n" + o, "sphere");
    expect(b + n + "radios = 3\n" + o, "radios");
    expect(b + n + "radios = 3\n" + o, "radius");
    expect(b + "[node.ball]\ntype = \"sphere\"\n" + o, "has no radius");
    expect(b + "[node.ball]\ntype = \"sphere\"\nradius = -1\n" + o, "must be positive");
    expect(b + "[node.ball]\ntype = \"sphere\"\nradius = \"sice * 2\"\n" + o,
           "unknown name 'sice'");
    expect(b + "[node.ball]\ntype = \"sphere\"\nradius = \"1 +\"\n" + o, "r.toml:6:10");
    expect(b + "[node.ball]\ntype = \"sphere\"\nradius = \"1 / 0\"\n" + o, "is inf");
    expect(b +
               "[node.ball]\ntype = \"abs\"\ninput = \"a\"\n[node.a]\ntype = \"abs\"\n"
               "input = \"ball\"\n" +
               o,
           "refers to itself: ball -> a -> ball");
    expect(b +
               "[node.ball]\ntype = \"abs\"\ninput = { type = \"curl\", size = 1 }\n[node.c]\n"
               "type = \"falloff\"\nedge = 1\ninput = \"ball\"\n" +
               o,
           "is a vector; expected a scalar");
    expect(b + "[node.ball]\ntype = \"warp\"\ninput = 1\nby = 2\namount = 1\n" + o,
           "is a scalar; expected a vector");
    expect(n + o, "bounds");
    expect("[bounds]\nmin = [1, 0, 0]\nmax = [0, 1, 1]\n" + n + o, "lies below min along x");
    expect(b + n, "no [[output]]");
    expect(b + n + o + o, "is used by another output");
    expect(b + n + o + "mask = \"dens\"\n", "is not another output");
    expect("[let]\na = \"b\"\nb = \"a\"\n" + b + n + o, "needs itself");
    expect("[parameters]\nx = { default = 3, range = [4, 5] }\n" + b + n + o,
           "default outside its range");
    expect("nodes = 3\n" + b + n + o, "nodes");
    expect(b + n + o + "[node.unused]\ntype = \"sphere\"\n", "has no radius");
}

TEST(Recipe, SettingsAreChecked) {
    const std::string text =
        "[parameters]\nsize = { default = 3, range = [1, 9] }\n"
        "count = { default = 3, integer = true }\n" +
        std::string(bounds) + ball + output;
    EXPECT_NE(mistake(text, {{"sise", 3, "--set sise=3"}}).find("did you mean 'size'"),
              std::string::npos);
    EXPECT_NE(mistake(text, {{"size", 10, "--set size=10"}}).find("between 1 and 9"),
              std::string::npos);
    EXPECT_NE(mistake(text, {{"count", 1.5, "--set count=1.5"}}).find("whole number"),
              std::string::npos);
}

TEST(Recipe, SeedsAreNumbersThatCanBeCounted) {
    const std::string text =
        std::string(bounds) + "[node.ball]\ntype = \"perlin\"\nsize = 1\n" + output;
    EXPECT_NE(mistake(text, {{"seed", 1e300, "--set seed=1e300"}}).find("the recipe's seed"),
              std::string::npos);
    EXPECT_EQ(mistake(text, {{"seed", -7, "--set seed=-7"}}), "no error");
}

TEST(Recipe, EveryPresetCanBeMade) {
    ASSERT_FALSE(presets().empty());
    for (const auto& [name, text] : presets()) {
        const Recipe recipe = makeRecipe({std::string(text), name, ""}, {});
        EXPECT_FALSE(recipe.about.empty()) << name;
        for (const Parameter& p : recipe.parameters.all())
            EXPECT_FALSE(p.about.empty()) << name << ": " << p.name;
    }
}

}  // namespace
}  // namespace woodcock::test
