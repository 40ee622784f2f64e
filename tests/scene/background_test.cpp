// SPDX-License-Identifier: Apache-2.0
// Grids whose background is not 0: where the medium ends, from the text of a scene to the picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scene/built_scene.h"
#include "tests/support/expect_error.h"
#include "tests/support/expect_estimate.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace medium;
using namespace proof;
using namespace render;
using namespace scene;

namespace {

constexpr double haze = 0.25;
constexpr double endless = std::numeric_limits<double>::infinity();

/// Ten voxels along each axis, of 2, in a haze.
GridSpec cube(const std::string& name, double background = haze) {
    GridSpec grid;
    grid.name = name;
    grid.background = {background, background, background};
    grid.box = {{0, 0, 0}, {9, 9, 9}};
    grid.value = [](Vec3i) { return 2.0; };
    return grid;
}

class VolumeBackground : public ::testing::Test {
protected:
    VolumeBackground() {
        GridSpec colour = cube("Cd");
        colour.type = VdbType::Vec3s;
        colour.value = {};
        colour.colour = [](Vec3i) { return Vec3d{0.75, 0.75, 0.75}; };
        writeVdb(dir_ / "a.vdb",
                 {cube("density"), cube("absorption"), colour, cube("flame"), cube("clear", 0)});
    }
    static std::string volume(const std::string& keys) {
        return "[[volume]]\nfile = \"a.vdb\"\n" + keys + "\n";
    }
    BuiltScene build(const std::string& keys) { return buildLit(volume(keys), dir_.path()); }
    double depth(const std::string& keys, Vec3d origin, Vec3d direction = {1, 0, 0}) {
        return double{
            exactOpticalDepth(build(keys).scene.medium, origin, direction, 0, endless)[0]};
    }
    /// From the middle of one side to the other, and what is drawn along it.
    RgbEstimate picture(const std::string& keys, const std::string& more = "", int samples = 512) {
        const std::string light = more.find("[[light]]") == std::string::npos
                                      ? "[[light]]\ntype = \"environment\"\n"
                                      : "";
        const Scene scene = sceneFrom(
            volume(keys) + more + light + pencilCamera({-20, 4.5, 4.5}, {1, 0, 0}), dir_.path());
        return evenRadiance(renderScene(scene, {.samples = samples}).film);
    }
    TempDir dir_;
};

// Ten voxels of 2, and a ramp down to the haze on either side.
constexpr double through = 9 * 2.0 + (2.0 + haze);
// Half a voxel beside them: halfway between 2 and the haze, with ramps at the ends.
constexpr double beside = 9 * (2.0 + haze) / 2 + ((2.0 + haze) / 2 + haze);

TEST_F(VolumeBackground, EndsOneVoxelAroundTheActiveOnes) {
    EXPECT_NEAR(depth("scale = 1", {-20, 4.5, 4.5}), through, 1e-5);
    EXPECT_NEAR(depth("scale = 1", {-20, -0.5, 4.5}), beside, 1e-5);
    EXPECT_NEAR(depth("scale = 1", {-20, -0.999, 4.5}), 11 * haze, 0.02);
    EXPECT_EQ(depth("scale = 1", {-20, -1.001, 4.5}), 0);
    EXPECT_EQ(depth("scale = 1", {-20, 30, 4.5}), 0);
    EXPECT_EQ(depth("scale = 1", {11, 4.5, 4.5}), 0);                               // beyond it
    EXPECT_NEAR(depth("scale = 1", {5, 4.5, 4.5}), 4 * 2 + through / 2 - 9, 1e-5);  // from within
    EXPECT_NEAR(depth("scale = 1\nbackground = \"clip\"", {-20, 4.5, 4.5}), through, 1e-5);
    const BuiltScene built = build("scale = 1");
    const MediumPart& part = built.scene.medium.parts.at(0);
    EXPECT_FALSE(part.unbounded());
    EXPECT_NEAR(part.value({-0.9, 5, 5})[0], haze + 0.1 * (2 - haze), 1e-6);
    EXPECT_EQ(part.value({-1.1, 5, 5}), Rgb(0.0f));
    EXPECT_EQ(part.worldBounds().lower, (Vec3d{-1, -1, -1}));
    EXPECT_EQ(part.worldBounds().upper, (Vec3d{10, 10, 10}));
}

TEST_F(VolumeBackground, IsTrackedAsFarAsThat) {
    const double expected = std::exp(-0.05 * through);
    expectAgrees(picture("scale = 0.05\nalbedo = 0"), {expected, expected, expected}, 0.01);
    expectAgrees(picture("scale = 1\nalbedo = 1"), {1, 1, 1}, 1e-3);
}

TEST_F(VolumeBackground, SaysWhatItLeavesOut) {
    const std::vector<std::string> notes = build("scale = 1").loaded.notes;
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_EQ(notes[0], "grid 'density' in " + (dir_ / "a.vdb").string() +
                            " has a background of 0.25: only what lies within the bounds of its "
                            "active voxels is drawn");
    EXPECT_NE(notes[1].find("background = \"endless\""), std::string::npos);
    EXPECT_TRUE(build("density = \"clear\"\nscale = 1").loaded.notes.empty());
    // A colour outside of the smoke is no medium.
    EXPECT_TRUE(build("density = \"clear\"\nscale = 1\nalbedo_grid = \"Cd\"").loaded.notes.empty());
}

TEST_F(VolumeBackground, OfCoefficientsEndsWithTheirOwnVoxels) {
    EXPECT_NEAR(depth("sigma_a = { grid = \"absorption\" }", {-20, 4.5, 4.5}), through, 1e-5);
    EXPECT_NEAR(depth("sigma_a = { grid = \"absorption\" }\nsigma_s = { grid = \"density\" }",
                      {-20, 4.5, 4.5}),
                2 * through, 1e-5);
    const BuiltScene coloured = build("scale = 1\nalbedo_grid = \"Cd\"");
    EXPECT_NEAR(coloured.scene.medium.parts[0].sigmaS({-0.5, 4.5, 4.5})[0],
                (2 + haze) / 2 * (0.75 + haze) / 2, 1e-6);
}

TEST_F(VolumeBackground, OfEmissionEndsToo) {
    const std::string glow = "sigma_a = 0\nemission = { grid = \"flame\", scale = 0.1 }";
    const double q = 0.1 * through;
    expectAgrees(picture(glow, "[[light]]\ntype = \"environment\"\nradiance = 0\n", 256), {q, q, q},
                 0.01);
    EXPECT_EQ(build(glow).scene.medium.emission.at(0).value({-1.5, 4, 4}), Rgb(0));
    expectError(ErrorKind::Input, "grid 'flame' in ",
                [&] { build(glow + "\nbackground = \"endless\""); });
}

TEST_F(VolumeBackground, MayBeEndless) {
    const std::string keys = "scale = 1\nbackground = \"endless\"";
    EXPECT_EQ(depth(keys, {-20, 30, 4.5}), endless);
    const BuiltScene scene = build(keys);
    EXPECT_TRUE(scene.scene.medium.parts.at(0).unbounded());
    ASSERT_EQ(scene.loaded.notes.size(), 1u);
    EXPECT_NE(scene.loaded.notes[0].find("fills all of space"), std::string::npos);
}

/// No light comes from infinity, and nothing takes for ever.
TEST_F(VolumeBackground, EndlessFogOfAlbedoOneIsBlackAndDrawn) {
    for (const char* albedo : {"1", "0.999999", "0.5"}) {
        const RgbEstimate black =
            picture(fmt::format("scale = 1\nalbedo = {}\nbackground = \"endless\"", albedo));
        EXPECT_EQ(black[0].mean, 0) << albedo;
    }
}

/// Within walls that shine evenly everything is as bright as they are, however often light
/// scatters before it meets them.
TEST_F(VolumeBackground, PathsInEndlessFogEndWithoutBias) {
    const std::string room =
        "[[material]]\nname = \"glow\"\ntype = \"emissive\"\nradiance = 1\nboth_sides = true\n"
        "[[surface]]\nbox = { min = [-30, -30, -30], max = [40, 40, 40] }\nmaterial = \"glow\"\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0\n";
    expectAgrees(picture("scale = 2\nalbedo = 1\nbackground = \"endless\"", room, 128), {1, 1, 1},
                 0.03);
}

TEST_F(VolumeBackground, FillsTheSurfaceThatTheVolumeIsInsideOf) {
    const std::string ball =
        "[[material]]\nname = \"skin\"\ntype = \"interface\"\n[[surface]]\nname = \"room\"\n"
        "box = { min = [-5, -5, -5], max = [15, 15, 15] }\nmaterial = \"skin\"\n";
    const auto seen = [&](const std::string& keys) {
        return picture("inside = \"room\"\nalbedo = 0\nscale = 0.05\n" + keys, ball);
    };
    const double filled = std::exp(-0.05 * (through + 9 * haze));
    const double ended = std::exp(-0.05 * through);
    expectAgrees(seen(""), {filled, filled, filled}, 0.01);
    expectAgrees(seen("background = \"endless\""), {filled, filled, filled}, 0.01);
    expectAgrees(seen("background = \"clip\""), {ended, ended, ended}, 0.01);
}

TEST_F(VolumeBackground, EndsThereInCoarserLevelsToo) {
    const SceneDescription description = parseSceneText(
        volume("scale = 1") +
            "[[light]]\ntype = \"environment\"\n[camera]\neye = [-2000, 4.5, 4.5]\n"
            "look_at = [0, 4.5, 4.5]\n[render]\nresolution = [64, 64]\nlevel_of_detail = 0.2\n",
        "scene.toml", dir_.path(), {});
    const Scene scene = buildScene(description, loadScene(description));
    const Affine3d& voxel = scene.medium.parts.at(0).description().worldFromIndex;
    const double width = voxel.column[0].x;
    ASSERT_GE(width, 2);
    const double coarse =
        double{exactOpticalDepth(scene.medium, {-20, 4.5, 4.5}, {1, 0, 0}, 0, endless)[0]};
    EXPECT_NEAR(coarse, through, 2 * width * haze + 0.05 * through);
}

TEST_F(VolumeBackground, IsWrittenAndDistinguishesScenes) {
    const auto parse = [&](const std::string& keys) {
        return parseSceneText(volume(keys), "scene.toml", dir_.path(), {});
    };
    const SceneDescription usual = parse(""), clip = parse("background = \"clip\""),
                           all = parse("background = \"endless\"");
    EXPECT_EQ(writeScene(usual, dir_.path()).find("background"), std::string::npos);
    EXPECT_NE(writeScene(all, dir_.path()).find("background = \"endless\""), std::string::npos);
    EXPECT_NE(writeScene(clip, dir_.path()).find("background = \"clip\""), std::string::npos);
    EXPECT_NE(sceneDigest(usual), sceneDigest(all));
    expectError(ErrorKind::Input, "known: clip, endless",
                [&] { parse("background = \"endles\""); });
    expectError(ErrorKind::Input, "needs a file", [&] {
        parseSceneText(
            "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 1\n"
            "background = \"clip\"\n",
            "scene.toml", ".", {});
    });
}

/// Frames in which nothing is yet, beside others.
TEST(EmptyVolumes, LeaveTheOthersAsTheyAre) {
    const TempDir dir;
    GridSpec empty, smoke = cube("density", 0), colour;
    colour.name = "Cd", colour.type = VdbType::Vec3s;
    GridSpec heat;
    heat.name = "temperature";
    writeVdb(dir / "empty.vdb", {empty});
    writeVdb(dir / "none.vdb", {});
    writeVdb(dir / "smoke.vdb", {smoke, colour, heat});
    const std::string camera = pencilCamera({-20, 4.5, 4.5}, {1, 0, 0}),
                      light = "[[light]]\ntype = \"environment\"\n",
                      full = "[[volume]]\nfile = \"smoke.vdb\"\nscale = 0.05\nalbedo = 0\n";
    const auto draw = [&](const std::string& text) {
        return evenRadiance(
            renderScene(sceneFrom(text + light + camera, dir.path()), {.samples = 512}).film);
    };
    const double alone = std::exp(-0.05 * 20);
    for (const char* file : {"empty.vdb", "none.vdb"}) {
        const std::string nothing =
            fmt::format("[[volume]]\nfile = \"{}\"\nscale = 5\nemission = 3\n", file);
        const RgbEstimate sky = draw(nothing), both = draw(nothing + full);
        EXPECT_EQ(sky[0].mean, 1) << file;
        expectAgrees(both, {alone, alone, alone}, 0.01);
    }
    // What does not glow, and what is black: as the empty grids say.
    expectAgrees(draw(full + "blackbody = {}\n"), {alone, alone, alone}, 0.01);
    const BuiltScene black = buildLit(full + "albedo_grid = \"Cd\"\n", dir.path());
    EXPECT_EQ(black.loaded.notes.size(), 1u);
    EXPECT_EQ(black.scene.medium.parts.at(0).sigmaS({4, 4, 4}), Rgb(0));
}

}  // namespace
}  // namespace woodcock::test
