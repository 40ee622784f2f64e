// SPDX-License-Identifier: Apache-2.0
// What volumes emit, from the text of a scene to its medium.
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/medium/blackbody.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace medium;
using namespace proof;
using namespace scene;

namespace {

GridSpec cube(const std::string& name, double value) {
    GridSpec grid;
    grid.name = name;
    grid.box = {{0, 0, 0}, {7, 7, 7}};
    grid.value = [value](Vec3i) { return value; };
    grid.worldFromIndex = Affine3d::scale({0.5, 0.5, 0.5});
    return grid;
}

SceneDescription parse(const std::string& volume, const TempDir& dir) {
    return parseSceneText("[[volume]]\n" + volume +
                              "\n[[light]]\ntype = \"environment\"\n"
                              "[camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\n",
                          "scene.toml", dir.path(), {});
}
Medium mediumOf(const std::string& volume, const TempDir& dir) {
    const SceneDescription scene = parse(volume, dir);
    return buildScene(scene, loadScene(scene)).medium;
}
Rgb emissionAt(const Medium& medium, Vec3d p) {
    Rgb sum;
    for (const EmissionPart& part : medium.emission) sum += part.value(p);
    return sum;
}

TEST(VolumeEmission, IsTimesItsGrid) {
    const TempDir dir;
    writeVdb(dir / "fire.vdb", {cube("density", 2), cube("flame", 3)});
    const std::string file = "file = \"fire.vdb\"\n";
    const Vec3d inside{2, 2, 2}, outside{9, 2, 2};
    const Medium own =
        mediumOf(file + "scale = 1\nemission = { grid = \"flame\", scale = [1, 2, 4] }", dir);
    EXPECT_EQ(emissionAt(own, inside), Rgb(3, 6, 12));
    EXPECT_EQ(emissionAt(own, outside), Rgb(0));
    EXPECT_EQ(own.parts.size(), 1u);
    EXPECT_EQ(emissionAt(mediumOf(file + "scale = 1\nemission = 5", dir), inside), Rgb(10));
    EXPECT_EQ(
        emissionAt(mediumOf(file + "density = \"flame\"\nsigma_s = 1\nemission = 5", dir), inside),
        Rgb(15));
}

TEST(VolumeEmission, NeedsNoDensity) {
    const TempDir dir;
    writeVdb(dir / "fire.vdb", {cube("flame", 3), cube("temperature", 2)});
    const Medium medium = mediumOf(
        "file = \"fire.vdb\"\nsigma_a = 0\nblackbody = { scale = 500, offset = 600, intensity = 2, "
        "colour = [1, 0.5, 0] }",
        dir);
    EXPECT_TRUE(medium.parts.empty());
    const Rgb expected = blackbodyRadiance(1600) * Rgb(2, 1, 0);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(emissionAt(medium, {2, 2, 2})[c], expected[c], 1e-6 * expected[0]);
}

TEST(VolumeEmission, OfBoxes) {
    const TempDir dir;
    const Medium medium = mediumOf(
        "box = { min = [0, 0, 0], max = [1, 1, 1] }\nemission = [1, 2, 3]\n"
        "transform = { translate = [5, 0, 0] }",
        dir);
    EXPECT_TRUE(medium.parts.empty());
    EXPECT_EQ(emissionAt(medium, {5.5, 0.5, 0.5}), Rgb(1, 2, 3));
    EXPECT_EQ(emissionAt(medium, {0.5, 0.5, 0.5}), Rgb(0));
}

TEST(VolumeEmission, IsWrittenAsItIsRead) {
    const TempDir dir;
    for (const char* text :
         {"file = \"a.vdb\"\nsigma_a = 0\nblackbody = { temperature = \"t\", scale = 1400, "
          "offset = 3, intensity = 0.5, colour = [1, 0.5, 0.25] }",
          "file = \"a.vdb\"\nscale = 2\nemission = [1, 2, 3]\nblackbody = {}",
          "file = \"a.vdb\"\nsigma_s = 2\nemission = { grid = \"flame\", scale = 3 }",
          "box = { min = [0, 0, 0], max = [1, 1, 1] }\nemission = 0.1"}) {
        SceneDescription scene = parse(text, dir);
        const std::string written = writeScene(scene, dir.path());
        SceneDescription again = parseSceneText(written, "again.toml", dir.path(), {});
        scene.places = again.places = {};
        EXPECT_EQ(again, scene) << written;
    }
}

TEST(VolumeEmission, MistakesNameTheirPlace) {
    const TempDir dir;
    GridSpec everywhere = cube("glow", 3);
    everywhere.background = {1, 0, 0};
    writeVdb(dir / "fire.vdb", {cube("density", 2), everywhere, cube("temperature", 1)});
    const auto expect = [&](const std::string& volume, const std::string& message) {
        expectError(ErrorKind::Input, message, [&] { mediumOf(volume, dir); });
    };
    const std::string file = "file = \"fire.vdb\"\nscale = 1\n";
    expect(file + "emission = -1", "scene.toml:4:12: volume[0].emission is -1");
    expect(file + "background = \"endless\"\nemission = { grid = \"glow\" }",
           "scene.toml:5:12: grid 'glow' in ");
    expect(file + "emission = { grid = \"flam\" }", "grid 'flam' not found in ");
    expect(file + "blackbody = { temp = \"t\" }", "temp");
    expect(file + "blackbody = { scale = 1e14 }", "is too hot: up to 1e+14 kelvins");
    expect("box = { min = [0, 0, 0], max = [1, 1, 1] }\nemission = 1\nblackbody = {}",
           "needs a file");
}

}  // namespace
}  // namespace woodcock::test
