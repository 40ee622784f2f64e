// SPDX-License-Identifier: Apache-2.0
// Spots, rectangles, disks and photometric files, from the scene file to the built light.
#include <gtest/gtest.h>

#include "tests/scene/built_scene.h"
#include "tests/support/paths.h"
#include "tests/support/scene_mistake.h"

namespace woodcock::test {

using namespace light;
using namespace scene;

namespace {

const std::string box = "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 1\n";

template <class L>
L built(const std::string& lines, const std::filesystem::path& base = ".") {
    const BuiltScene built = buildLit(box + "[[light]]\n" + lines, base);
    return std::get<L>(built.scene.lights.lights().at(0));
}
std::string mistake(const std::string& lines) { return mistakeIn(box + "[[light]]\n" + lines); }
void expectNear(Vec3d a, Vec3d b) { EXPECT_NEAR(length(a - b), 0, 1e-12) << a.x << " " << a.y; }

TEST(Lamps, ASpotShinesAlongItsDirectionOrAtAPoint) {
    for (const char* aim : {"direction = [0, -3, 0]", "look_at = [0, 1, 0]"}) {
        const auto spot = built<SpotLight>(
            std::string("type = \"spot\"\nposition = [0, 4, 0]\nintensity = [8, 4, 2]\ncone = 60\n"
                        "blend = 0\n") +
            aim);
        EXPECT_EQ(spot.sample({0, 2, 0}, 0, 0).weight, (Rgb{2, 1, 0.5}));
        EXPECT_EQ(spot.sample({2, 2, 0}, 0, 0).weight, Rgb(0.0f));
    }
    const auto spot = built<SpotLight>(
        "type = \"spot\"\nposition = [0, 4, 0]\npower = 12.566370614359172\nlook_at = [0, 0, 0]");
    EXPECT_NEAR(spot.sample({0, 3, 0}, 0, 0).weight[0], 1, 1e-6);
}

TEST(Lamps, ARectangleLiesWhereItsMatrixOrItsAimSays) {
    const auto plain = built<RectangleLight>("type = \"rectangle\"\nsize = [4, 2]").flat;
    expectNear(plain.normal, {0, 1, 0});
    EXPECT_EQ(plain.halfX, 2);
    EXPECT_EQ(plain.halfY, 1);
    const auto scaled =
        built<RectangleLight>(
            "type = \"rectangle\"\ntransform = { translate = [1, 2, 3], rotate = [180, 0, 0], "
            "scale = [2, 3, 4] }\nspread = 90\ntwo_sided = true\nvisible = false\nradiance = 3")
            .flat;
    expectNear(scaled.centre, {1, 2, 3});
    expectNear(scaled.normal, {0, -1, 0});
    EXPECT_NEAR(scaled.halfX, 1, 1e-12);
    EXPECT_NEAR(scaled.halfY, 2, 1e-12);
    EXPECT_TRUE(scaled.twoSided);
    EXPECT_FALSE(scaled.visible);
    EXPECT_EQ(scaled.radiance, Rgb(3));
    EXPECT_NEAR(scaled.spread.largest(), 1 / (1 - pi / 4), 1e-12);

    const auto aimed =
        built<RectangleLight>("type = \"rectangle\"\nposition = [0, 0, 5]\nlook_at = [3, 0, 5]")
            .flat;
    expectNear(aimed.centre, {0, 0, 5});
    expectNear(aimed.normal, {1, 0, 0});
    EXPECT_NEAR(aimed.x.y, 0, 1e-12);  // its width lies level
    const auto rolled = built<RectangleLight>(
                            "type = \"rectangle\"\nposition = [0, 0, 5]\ndirection = [1, 0, 0]\n"
                            "roll = 90")
                            .flat;
    EXPECT_NEAR(std::abs(rolled.x.y), 1, 1e-12);
    const auto down =
        built<RectangleLight>("type = \"rectangle\"\nposition = [0, 5, 0]\ndirection = [0, -1, 0]")
            .flat;
    expectNear(down.x, {1, 0, 0});
}

/// Far away on its axis, a light of power P sends P / (pi distance^2).
TEST(Lamps, PowerIsThatOfTheSideThatShines) {
    for (const char* shape :
         {"type = \"rectangle\"\nsize = [0.1, 0.3]", "type = \"disk\"\nradius = 0.2"}) {
        const BuiltScene b = buildLit(box + "[[light]]\n" + shape + "\npower = 7");
        const Light& light = b.scene.lights.lights().at(0);
        double sum = 0;
        for (int i = 0; i < 1000; ++i) {
            const LightSample s = light.sample({0, 1000, 0}, (i + 0.5) / 1000, 0.37);
            sum += s.weight[0] / 1000;
        }
        EXPECT_NEAR(sum * 1e6, 7 / pi, 1e-4) << shape;
    }
}

TEST(Lamps, ADiskMayBecomeAnEllipse) {
    const auto disk =
        built<DiskLight>("type = \"disk\"\nradius = 2\ntransform = { scale = [3, 1, 1] }").flat;
    EXPECT_EQ(disk.halfX, 6);
    EXPECT_EQ(disk.halfY, 2);
}

TEST(Lamps, APointTurnsItsPhotometricFile) {
    const TempDir folder;
    // Shines downwards alone.
    writeText(
        folder / "down.ies",
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n17.783 17.783\n");
    const auto point = [&](const std::string& aim) {
        return built<PointLight>(
            "type = \"point\"\nposition = [0, 0, 0]\npower = 10\nies = \"down.ies\"\n" + aim,
            folder.path());
    };
    EXPECT_NEAR(point("").sample({0, -1, 0}, 0, 0).weight[0], 1, 1e-6);
    EXPECT_EQ(point("").sample({0, 1, 0}, 0, 0).weight[0], 0);
    EXPECT_NEAR(point("direction = [1, 0, 0]").sample({1, 0.5, 0}, 0, 0).weight[0], 0.8, 1e-6);
    EXPECT_EQ(point("look_at = [0, 0, 9]").sample({1, 1, -1}, 0, 0).weight[0], 0);

    writeText(folder / "broken.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1");
    EXPECT_EQ(buildMistake(box + "[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\n"
                                 "ies = \"broken.ies\"\n",
                           folder.path()),
              "scene.toml:7:7: " + (folder / "broken.ies").string() +
                  ":4: the file ends before the input watts");
    EXPECT_NE(buildMistake(box + "[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\n"
                                 "ies = \"none.ies\"\n",
                           folder.path())
                  .find("none.ies"),
              std::string::npos);
}

TEST(Lamps, SayWhatIsWrong) {
    const std::string spot = "type = \"spot\"\nposition = [0, 4, 0]\n";
    const std::string rectangle = "type = \"rectangle\"\n", disk = "type = \"disk\"\n";
    EXPECT_EQ(mistake(spot),
              "scene.toml:4:1: light[0] is a spot without look_at or direction; give look_at = [0, "
              "0, 0] (a point that it shines at) or direction = [0, -1, 0]");
    EXPECT_EQ(mistake(spot + "look_at = [0, 4, 0]"),
              "scene.toml:7:11: light[0].look_at is the light's own position, [0, 4, 0], so it "
              "points nowhere");
    EXPECT_EQ(mistake(spot + "direction = [0, 0, 0]"),
              "scene.toml:7:13: light[0].direction is [0, 0, 0], which points nowhere");
    EXPECT_NE(mistake(spot + "direction = [0, -1, 0]\nlook_at = [0, 0, 0]")
                  .find("both say where it shines"),
              std::string::npos);
    for (const char* line : {"cone = 0", "cone = 181", "cone = -3", "blend = 1.5", "blend = -0.1"})
        EXPECT_NE(mistake(spot + "direction = [0, -1, 0]\n" + line), "") << line;
    EXPECT_NE(mistake(spot + "direction = [0, -1, 0]\npower = 1\nintensity = 1").find("4 pi"),
              std::string::npos);
    for (const char* line : {"size = [0, 1]", "size = [1, -1]", "size = 1", "spread = 0",
                             "spread = 181", "transform = { scale = [0, 1, 1] }"})
        EXPECT_NE(mistake(rectangle + line), "") << line;
    for (const char* line : {"radius = 0", "radius = -1", "spread = -5"})
        EXPECT_NE(mistake(disk + line), "") << line;
    EXPECT_EQ(mistake(rectangle + "position = [0, 4, 0]"),
              "scene.toml:6:12: light[0].position needs to be told where the light shines; give "
              "look_at = [0, 0, 0] (a point that it shines at) or direction = [0, -1, 0]");
    EXPECT_EQ(mistake(disk + "direction = [0, -1, 0]"),
              "scene.toml:6:13: light[0].direction needs a position, such as position = [0, 2, 0]");
    EXPECT_NE(mistake(disk + "position = [0, 1, 0]\ndirection = [0, -1, 0]\n"
                             "transform = { scale = [2, 2, 2] }")
                  .find("both say where it is"),
              std::string::npos);
    EXPECT_EQ(
        mistake(rectangle + "matrix = [[1, 0.5, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
        "scene.toml:6:10: light[0].matrix shears: its axes must be perpendicular, as "
        "rectangles stay rectangles and disks disks or ellipses");
    EXPECT_EQ(mistake(rectangle + "radiance = 1e38\nspread = 0.01"),
              "scene.toml:6:12: light[0].radiance makes more radiance than a float can hold, for "
              "an area of 1 and a spread of 0.01");
    EXPECT_EQ(mistake("type = \"point\"\nposition = [0, 0, 0]\nroll = 3"),
              "scene.toml:7:8: light[0].roll turns a photometric file, and the light has none; "
              "give ies");
}

}  // namespace
}  // namespace woodcock::test
