// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/precision.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace proof;
using namespace render;
using namespace scene;

namespace {

const std::string light = "[[light]]\ntype = \"environment\"\nradiance = 1\n";

std::string camera(double eye) {
    return fmt::format("[camera]\neye = [0, 0, {}]\nlook_at = [0, 0, 0]\n", eye);
}
std::string box(double half, double sigma, double centre = 0) {
    return fmt::format(
        "[[volume]]\nbox = {{ min = [-{0}, -{0}, -{0}], max = [{0}, {0}, {0}] }}\n"
        "sigma_a = 0\nsigma_s = {1}\ntransform = {{ translate = [{2}, 0, 0] }}\n",
        half, sigma, centre);
}
std::vector<std::string> warnings(const std::string& text,
                                  const std::filesystem::path& directory = ".") {
    return precisionWarnings(sceneFrom(text, directory));
}

void expectNone(const std::vector<std::string>& found) {
    EXPECT_TRUE(found.empty()) << found.front();
}
void expectOne(const std::vector<std::string>& found, const std::string& part) {
    ASSERT_EQ(found.size(), 1u) << part;
    EXPECT_NE(found[0].find(part), std::string::npos) << found[0] << "\nlacks " << part;
}

TEST(Precision, OrdinaryScenesGiveNone) {
    expectNone(warnings(box(1, 1) + light + camera(5)));
    expectNone(warnings(box(1e-6, 1e6) + light + camera(5)));
    expectNone(warnings(box(1e6, 1e-6) + light + camera(5e7)));
    expectNone(warnings(box(1, 1e6, 1e7) + light + camera(5)));
    expectNone(warnings(box(1, 1e12) + light + camera(5)));
    expectNone(warnings(box(1, 0) + light + camera(5)));
}

TEST(Precision, ExamplesAndCloudsFromProductionGiveNone) {
    std::vector<SceneDescription> scenes{parseScene(sourceDir() / "data/scenes/box_of_fog.toml")};
    for (const char* name : {"teapot_cloud.vdb", "fire_0045.vdb"})
        if (const auto file = sharedDir() / "assets" / name; exists(file))
            scenes.push_back(parseSceneText(defaultSceneText({file}), name, ""));
    for (SceneDescription& scene : scenes) {
        LoadedScene loaded = loadScene(scene);
        completeScene(scene, loaded);
        expectNone(precisionWarnings(buildScene(scene, std::move(loaded))));
    }
}

TEST(Precision, MeanFreePathsBelowTheRoundingOfPositions) {
    expectOne(warnings(box(1, 1e12, 1e7) + light + camera(5)),
              "its mean free path is down to 1e-12");
}

TEST(Precision, OpticalDepthsThatAreNotTested) {
    expectOne(warnings(box(1, 1e20) + light + camera(5)), "its optical depth is up to 3.5e+20");
}

TEST(Precision, VoxelsBelowTheRoundingOfPositions) {
    const TempDir dir;
    GridSpec grid;
    grid.voxels = {{{1, 2, 3}, {1}}};
    writeVdb(dir / "voxel.vdb", {grid});
    const std::string volume =
        "[[volume]]\nfile = \"voxel.vdb\"\nscale = 1\ntransform = { scale = 0.01, translate = [";
    expectNone(warnings(volume + "1e6, 0, 0] }\n" + light + camera(5), dir.path()));
    expectOne(warnings(volume + "1e13, 0, 0] }\n" + light + camera(5), dir.path()),
              "its voxels are 0.01 wide");
}

TEST(Precision, CoefficientsBeyondFloats) {
    const TempDir dir;
    GridSpec grid;
    grid.voxels = {{{1, 2, 3}, {1e20}}};
    writeVdb(dir / "voxel.vdb", {grid});
    const std::string volume = "[[volume]]\nfile = \"voxel.vdb\"\nscale = ";
    expectNone(warnings(volume + "1e-20\n" + light + camera(5), dir.path()));
    expectOne(warnings(volume + "1e20\n" + light + camera(5), dir.path()),
              "sigma_t reaches 1e+20 x 1e+20");
}

TEST(Precision, CamerasThatAreTooFarAway) {
    expectNone(warnings(box(1, 1) + light + camera(1e10)));
    for (double eye : {1e16, 1e300})
        expectOne(warnings(box(1, 1) + light + camera(eye)),
                  fmt::format("the camera is at [0, 0, {:g}]", eye));
}

TEST(Precision, LocalLightsThatAreTooFarAway) {
    const auto lightAt = [](double at) {
        return fmt::format("[[light]]\ntype = \"point\"\nposition = [0, {}, 0]\nintensity = 1\n",
                           at);
    };
    expectNone(warnings(box(1, 1) + lightAt(1e10) + camera(5)));
    expectOne(warnings(box(1, 1) + lightAt(1e30) + camera(5)), "only 1e-60 of its light arrives");
}

TEST(Precision, SunsThatAreTooNarrow) {
    const auto sun = [](double diameter) {
        return fmt::format(
            "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0]\nangular_diameter = {}\n", diameter);
    };
    for (double diameter : {0.0, 0.53, 1e-9})
        expectNone(warnings(box(1, 1) + sun(diameter) + camera(5)));
    for (double diameter : {1e-18, 1e-200})
        expectOne(warnings(box(1, 1) + sun(diameter) + camera(5)), "a sun is so narrow");
}

}  // namespace
}  // namespace woodcock::test
