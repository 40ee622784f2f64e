// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include <gtest/gtest.h>

#include "tests/scene/built_scene.h"
#include "tests/support/paths.h"
#include "woodcock/base/error.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace light;
using namespace medium;
using namespace proof;
using namespace render;
using namespace scene;

namespace {

constexpr Box3i block{{0, 0, 0}, {7, 7, 7}};

/// A grid of one value in `block`, with voxels half a unit wide.
GridSpec even(const std::string& name, double value) {
    GridSpec grid;
    grid.name = name;
    grid.box = block;
    grid.value = [value](Vec3i) { return value; };
    grid.worldFromIndex = Affine3d::scale({0.5, 0.5, 0.5});
    return grid;
}
GridSpec evenColour(const std::string& name, Vec3d value) {
    GridSpec grid = even(name, 0);
    grid.type = proof::VdbType::Vec3s;
    grid.value = nullptr;
    grid.colour = [value](Vec3i) { return value; };
    return grid;
}

BuiltScene build(const TempDir& dir, const std::string& text) { return buildLit(text, dir.path()); }
std::string loadMistake(const TempDir& dir, const std::string& text) {
    return buildMistake(text, dir.path());
}

void expectNear(Rgb a, Rgb b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-6 * std::abs(b[i]) + 1e-9) << i;
}
Rgb sigmaT(const Medium& medium, Vec3d p) {
    Rgb sum;
    for (const MediumPart& part : medium.parts) sum += part.sigmaT(p);
    return sum;
}
Rgb sigmaS(const Medium& medium, Vec3d p) {
    Rgb sum;
    for (const MediumPart& part : medium.parts) sum += part.sigmaS(p);
    return sum;
}

const Vec3d inside{1.5, 1.5, 1.5};  // voxel [3, 3, 3]

TEST(BuildScene, DensityWithScaleAndAlbedo) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {even("density", 3), even("other", 5)});
    const BuiltScene b = build(
        dir, "[[volume]]\nfile = \"a.vdb\"\nscale = [1, 2, 4]\nalbedo = [0.5, 1, 0.25]\ng = 0.5");
    ASSERT_EQ(b.scene.medium.parts.size(), 1u);
    expectNear(sigmaT(b.scene.medium, inside), Rgb(3, 6, 12));
    expectNear(sigmaS(b.scene.medium, inside), Rgb(1.5f, 6, 3));
    EXPECT_EQ(b.scene.medium.parts[0].phase().meanCosine(), 0.5);
    EXPECT_EQ(sigmaT(b.scene.medium, {-5, 0, 0}), Rgb(0));
}

/// A vec3 density: extinction of red, green and blue apart, each as in closed form.
TEST(BuildScene, VectorDensitiesAreExtinctionsOfTheChannels) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {evenColour("density", {1, 0.5, 0})});
    const BuiltScene built =
        build(dir, "[[volume]]\nfile = \"a.vdb\"\nscale = 2\nalbedo = [1, 0.5, 1]\n");
    ASSERT_EQ(built.scene.medium.parts.size(), 1u);
    EXPECT_TRUE(built.scene.medium.parts[0].chromatic());
    expectNear(sigmaT(built.scene.medium, {1, 1, 1}), {2, 1, 0});
    expectNear(sigmaS(built.scene.medium, {1, 1, 1}), {2, 0.5f, 0});
    // Eight voxels of 0.5: interpolation keeps each voxel's integral.
    const Rgb depth = exactOpticalDepth(built.scene.medium, {1, 1, -10}, {0, 0, 1}, 0, 20);
    EXPECT_NEAR(depth[0], 2 * 1 * 4, 1e-5);
    EXPECT_NEAR(depth[1], 2 * 0.5 * 4, 1e-5);
    EXPECT_EQ(depth[2], 0);
    ASSERT_FALSE(built.loaded.notes.empty());
    EXPECT_NE(built.loaded.notes[0].find("red, green and blue"), std::string::npos);
}

TEST(BuildScene, AlbedoGridsMultiply) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {even("density", 2), evenColour("Cd", {0.5, 1, 0.25})});
    const BuiltScene b =
        build(dir, "[[volume]]\nfile = \"a.vdb\"\nscale = 3\nalbedo = 0.5\nalbedo_grid = \"Cd\"");
    expectNear(sigmaT(b.scene.medium, inside), Rgb(6));
    expectNear(sigmaS(b.scene.medium, inside), Rgb(1.5f, 3, 0.75f));
}

TEST(BuildScene, SigmasOfOneGridAreOnePart) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {even("density", 2)});
    const BuiltScene b =
        build(dir, "[[volume]]\nfile = \"a.vdb\"\nsigma_a = [1, 0, 2]\nsigma_s = [3, 4, 0]");
    ASSERT_EQ(b.scene.medium.parts.size(), 1u);
    expectNear(sigmaT(b.scene.medium, inside), Rgb(8, 8, 4));
    expectNear(sigmaS(b.scene.medium, inside), Rgb(6, 8, 0));
}

TEST(BuildScene, SigmasOfTwoGridsAreTwoPartsThatAdd) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {even("soot", 2), evenColour("steam", {1, 2, 3})});
    const BuiltScene b = build(dir,
                               "[[volume]]\nfile = \"a.vdb\"\n"
                               "sigma_a = { grid = \"soot\", scale = 3 }\n"
                               "sigma_s = { grid = \"steam\", scale = [1, 10, 100] }");
    ASSERT_EQ(b.scene.medium.parts.size(), 2u);
    expectNear(sigmaT(b.scene.medium, inside), Rgb(7, 26, 306));
    expectNear(sigmaS(b.scene.medium, inside), Rgb(1, 20, 300));
}

TEST(BuildScene, HomogeneousBoxesFillTheirTransformedBox) {
    const TempDir dir;
    const BuiltScene b = build(dir,
                               "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\n"
                               "sigma_a = 1\nsigma_s = [2, 3, 4]\n"
                               "transform = { translate = [10, 0, 0], scale = [2, 1, 1] }");
    expectNear(sigmaT(b.scene.medium, {11.9, 0.5, 0.5}), Rgb(3, 4, 5));
    expectNear(sigmaS(b.scene.medium, {11.9, 0.5, 0.5}), Rgb(2, 3, 4));
    EXPECT_EQ(sigmaT(b.scene.medium, {12.1, 0.5, 0.5}), Rgb(0));
    EXPECT_EQ(sigmaT(b.scene.medium, {0.5, 0.5, 0.5}), Rgb(0));
}

TEST(BuildScene, TransformsComeAfterTheGridsOwn) {
    const TempDir dir;
    GridSpec grid = even("density", 0);
    grid.value = [](Vec3i v) { return v == Vec3i{4, 2, 1} ? 1.0 : 0.0; };
    writeVdb(dir / "a.vdb", {grid});
    const BuiltScene b = build(dir,
                               "[[volume]]\nfile = \"a.vdb\"\nscale = 7\n"
                               "transform = { rotate = [0, 0, 90], translate = [0, 0, 5] }");
    // Voxel [4, 2, 1] stands at (2, 1, 0.5) in the file; a quarter turn about z: (-1, 2, 0.5).
    expectNear(sigmaT(b.scene.medium, {-1, 2, 5.5}), Rgb(7));
    EXPECT_EQ(sigmaT(b.scene.medium, {2, 1, 5.5}), Rgb(0));
}

TEST(BuildScene, VolumesShareGrids) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {even("density", 1)});
    const std::string volume = "[[volume]]\nfile = \"a.vdb\"\nscale = 1\n";
    const BuiltScene b = build(dir, volume + volume + volume + "repair = true\n");
    ASSERT_EQ(b.scene.medium.parts.size(), 3u);
    EXPECT_EQ(b.scene.medium.parts[0].field(), b.scene.medium.parts[1].field());
    EXPECT_NE(b.scene.medium.parts[0].field(), b.scene.medium.parts[2].field());
    expectNear(sigmaT(b.scene.medium, inside), Rgb(3));
}

TEST(BuildScene, VolumesOfNothingLeaveNoPart) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {even("density", 1)});
    const BuiltScene b = build(dir,
                               "[[volume]]\nfile = \"a.vdb\"\nscale = 0\n"
                               "[[volume]]\nfile = \"a.vdb\"\nsigma_a = 0\nsigma_s = 1\n");
    ASSERT_EQ(b.scene.medium.parts.size(), 1u);
    expectNear(sigmaS(b.scene.medium, inside), Rgb(1));
}

TEST(BuildScene, LightsKeepTheirOrderAndNumbers) {
    const TempDir dir;
    const SceneDescription description = parseSceneText(
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 1\n"
        "[[light]]\ntype = \"sphere\"\nposition = [1, 2, 3]\nradius = 0.5\nradiance = 2\n"
        "visible = false\n"
        "[[light]]\ntype = \"sun\"\ndirection = [0, -2, 0]\nirradiance = [1, 2, 3]\n"
        "[[light]]\ntype = \"point\"\nposition = [4, 5, 6]\nintensity = 7\n"
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n",
        "scene.toml", ".");
    const auto lights = buildScene(description, loadScene(description)).lights.lights();
    ASSERT_EQ(lights.size(), 3u);
    const auto& sphere = std::get<SphereLight>(lights[0]);
    EXPECT_EQ(sphere.position, (Vec3d{1, 2, 3}));
    EXPECT_EQ(sphere.radius, 0.5);
    EXPECT_EQ(sphere.radiance, Rgb(2));
    EXPECT_FALSE(sphere.visible);
    EXPECT_EQ(std::get<Sun>(lights[1]).towards(), (Vec3d{0, 1, 0}));
    EXPECT_EQ(std::get<Sun>(lights[1]).irradiance(), Rgb(1, 2, 3));
    EXPECT_EQ(std::get<PointLight>(lights[2]).intensity, Rgb(7));
}

/// A lat-long picture (PFM: rows from the bottom) that is red towards its centre column, at the
/// horizon, and blue at the top.
void writeSky(const std::filesystem::path& file) {
    constexpr int width = 64, height = 32;
    std::string bytes = "PF\n64 32\n-1.0\n";
    for (int row = 0; row < height; ++row)
        for (int x = 0; x < width; ++x) {
            const bool top = row >= 28, centre = !top && std::abs(x - width / 2) < 4;
            const float rgb[3] = {centre ? 1.0f : 0.0f, 0.0f, top ? 1.0f : 0.0f};
            bytes.append(reinterpret_cast<const char*>(rgb), sizeof rgb);
        }
    writeText(file, bytes);
}

TEST(BuildScene, EnvironmentImagesTurnAboutTheUpAxis) {
    const TempDir dir;
    writeSky(dir / "sky.pfm");
    const auto radiance = [&](const std::string& lines, Vec3d direction) {
        const SceneDescription description = parseSceneText(
            "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 1\n"
            "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n"
            "[[light]]\ntype = \"environment\"\nimage = \"sky.pfm\"\nradiance = 2\n" +
                lines,
            "scene.toml", dir.path());
        const Scene scene = buildScene(description, loadScene(description));
        return std::get<Environment>(scene.lights.lights()[0]).radiance(direction);
    };
    const Rgb red(2, 0, 0), blue(0, 0, 2), black(0);
    EXPECT_EQ(radiance("", {0, 0, -1}), red);
    EXPECT_EQ(radiance("", {0, 1, 0}), blue);
    EXPECT_EQ(radiance("", {1, 0, 0}), black);
    // Counter-clockwise from above: from -z to -x.
    EXPECT_EQ(radiance("rotation = 90", {-1, 0, 0}), red);
    EXPECT_EQ(radiance("rotation = 90", {0, 0, -1}), black);
    EXPECT_EQ(radiance("up = \"z\"", {0, 1, 0}), red);
    EXPECT_EQ(radiance("up = \"z\"", {0, 0, 1}), blue);
    // Seen from +z, from +y to -x.
    EXPECT_EQ(radiance("up = \"z\"\nrotation = 90", {-1, 0, 0}), red);
}

TEST(BuildScene, CamerasLookWhereTheyAreTold) {
    SceneDescription description = parseSceneText(
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 1\n" + lightAndCamera, "s",
        ".");
    const auto middle = [&] {
        return buildScene(description, loadScene(description)).camera.ray(50, 50, 100, 100);
    };
    EXPECT_EQ(middle().origin, (Vec3d{0, 0, 10}));
    EXPECT_EQ(middle().direction, (Vec3d{0, 0, -1}));
    description.camera.pose = Affine3d::translate({1, 2, 3});
    EXPECT_EQ(middle().origin, (Vec3d{1, 2, 3}));
    description.camera.pose.reset();
    EXPECT_THROW(middle(), Error);
}

TEST(LoadScene, MistakesNameThePlaceInTheScene) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {even("density", 1), evenColour("vel", {1, 2, 3})});
    const std::string file = (dir / "a.vdb").string();
    const std::string unknown =
        loadMistake(dir, "[[volume]]\nfile = \"a.vdb\"\nscale = 1\ndensity = \"densty\"");
    EXPECT_EQ(unknown.substr(0, 17), "scene.toml:4:11: ");
    EXPECT_NE(unknown.find("densty"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find("density"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find(file), std::string::npos) << unknown;
    const std::string vector =
        loadMistake(dir, "[[volume]]\nfile = \"a.vdb\"\nscale = 1\ndensity = \"vel\"");
    EXPECT_EQ(vector.substr(0, 17), "scene.toml:4:11: ");
    EXPECT_NE(vector.find("is a vector grid"), std::string::npos) << vector;
    const std::string image = loadMistake(
        dir, "[[volume]]\nfile = \"a.vdb\"\n[[light]]\ntype = \"environment\"\nimage = \"no.exr\"");
    EXPECT_EQ(image.substr(0, 17), "scene.toml:5:9: c");
}

TEST(LoadScene, MistakesNameThePlaceOfTheValue) {
    const TempDir dir;
    GridSpec flaw = even("flaw", 1);
    flaw.voxels = {{{1, 1, 1}, {-1}}};
    writeVdb(dir / "a.vdb", {even("density", 1), flaw});
    writeVdb(dir / "b.vdb", {evenColour("vel", {1, 2, 3})});
    const auto place = [&](const std::string& lines, std::vector<std::string> overrides = {}) {
        try {
            loadScene(parseSceneText("[[volume]]\n" + lines, "scene.toml", dir.path(), overrides));
        } catch (const Error& e) {
            const std::string what = e.what();
            return what.substr(0, what.find(": "));
        }
        return std::string("no mistake");
    };
    EXPECT_EQ(place("file = \"no.vdb\""), "scene.toml:2:8");
    EXPECT_EQ(place("g = 0\n  file = \"b.vdb\""), "scene.toml:3:10");  // no density in it
    EXPECT_EQ(place("file = \"a.vdb\"\ndensity = \"flaw\""), "scene.toml:3:11");
    EXPECT_EQ(place("file = \"a.vdb\"\nalbedo_grid = \"Cd\""), "scene.toml:3:15");
    EXPECT_EQ(place("file = \"a.vdb\"\nsigma_a = { scale = 1, grid = \"x\" }"), "scene.toml:3:31");
    EXPECT_EQ(place("file = \"a.vdb\"\nsigma_s = { grid = \"x\" }"), "scene.toml:3:20");
    EXPECT_EQ(place("file = \"a.vdb\"\nsigma_s = 2\ndensity = \"x\""), "scene.toml:4:11");
    EXPECT_EQ(place("file = \"a.vdb\"", {"volume[0].density=x"}), "--set volume[0].density=x");
    EXPECT_EQ(place("file = \"a.vdb\"\n[[volume]]\nfile = \"a.vdb\"", {"volume[1].file=no.vdb"}),
              "--set volume[1].file=no.vdb");
    EXPECT_EQ(place("file = \"a.vdb\"\n[[light]]\ntype = \"environment\"\nimage = \"a.vdb\""),
              "scene.toml:5:9");
}

TEST(LoadScene, AlbedosAboveOneAreRefusedOrRepaired) {
    const TempDir dir;
    GridSpec colour = evenColour("Cd", {0.5, 0.5, 0.5});
    colour.colour = [](Vec3i v) { return Vec3d{v.x == 3 ? 1.5 : 0.5, 0.5, 2.0 * (v.y == 3)}; };
    writeVdb(dir / "a.vdb", {even("density", 1), colour});
    const std::string text = "[[volume]]\nfile = \"a.vdb\"\nscale = 1\nalbedo_grid = \"Cd\"\n";
    // Two crossing planes of 8 x 8 voxels share 8.
    const std::string found =
        "albedo grid 'Cd' in " + (dir / "a.vdb").string() + " holds 120 voxels above 1 (up to 2)";
    EXPECT_EQ(
        loadMistake(dir, text),
        "scene.toml:4:15: " + found +
            "; an albedo lies between 0 and 1: --repair (in a scene file: repair = true) sets "
            "them to 1");
    const BuiltScene b = build(dir, text + "repair = true\n");
    ASSERT_EQ(b.loaded.notes.size(), 1u);
    EXPECT_EQ(b.loaded.notes[0], found + ": set to 1");
    EXPECT_EQ(sigmaS(b.scene.medium, inside), Rgb(1, 0.5f, 1));
    EXPECT_EQ(sigmaS(b.scene.medium, {1, 1, 1}), Rgb(0.5f, 0.5f, 0));
}

}  // namespace
}  // namespace woodcock::test
