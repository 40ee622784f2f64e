// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_estimate.h"
#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace medium;
using namespace proof;
using namespace render;
using namespace scene;

namespace {

/// 64 voxels a side, each half a unit wide, from [0, 0, 0] on; nothing outside.
GridSpec cube(const std::string& name, const std::function<double(Vec3i)>& value) {
    GridSpec grid;
    grid.name = name;
    grid.box = {{0, 0, 0}, {63, 63, 63}};
    grid.value = value;
    grid.worldFromIndex = Affine3d::scale({0.5, 0.5, 0.5});
    return grid;
}
double stripes(Vec3i v) { return v.x & 2 ? 2 : 1; }

struct Built {
    Scene scene;
    std::vector<std::string> notes;
};

Built build(const TempDir& dir, const std::string& volume, double levelOfDetail,
            const std::string& camera) {
    const SceneDescription description = parseSceneText(
        fmt::format("[[volume]]\nfile = \"a.vdb\"\n{}\n[[light]]\ntype = \"environment\"\n"
                    "[camera]\n{}\n[render]\nresolution = [150, 100]\nlevel_of_detail = {}\n",
                    volume, camera, levelOfDetail),
        "scene.toml", dir.path(), {});
    Built built;
    built.scene = buildScene(description, loadScene(description), &built.notes);
    return built;
}
/// Looks along -x at the cube, `distance` in front of its support, which ends at x = 32.
std::string cameraAt(double distance) {
    return fmt::format("eye = [{}, 16, 16]\nlook_at = [0, 16, 16]\nfov = 90", 32 + distance);
}
double voxelWidth(const MediumPart& part) {
    return length(part.description().worldFromIndex.column[0]);
}

/// At 90 degrees and 100 pixels a pixel is distance / 50 wide.
TEST(LevelOfDetail, HalvesAsOftenAsVoxelsStaySmall) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {cube("density", stripes)});
    const auto widthAt = [&](double pixels, const std::string& camera) {
        return voxelWidth(build(dir, "scale = 1", pixels, camera).scene.medium.parts[0]);
    };
    EXPECT_EQ(widthAt(0, cameraAt(1e4)), 0.5);
    for (double pixels : {0.5, 1.0, 3.0}) {
        EXPECT_EQ(widthAt(pixels, cameraAt(49 / pixels)), 0.5);
        EXPECT_EQ(widthAt(pixels, cameraAt(51 / pixels)), 1);
        EXPECT_EQ(widthAt(pixels, cameraAt(99 / pixels)), 1);
        EXPECT_EQ(widthAt(pixels, cameraAt(101 / pixels)), 2);
        EXPECT_EQ(widthAt(pixels, cameraAt(801 / pixels)), 16);
    }
    EXPECT_EQ(widthAt(1000, "eye = [16, 16, 16]\nlook_at = [0, 16, 16]"), 0.5);
    // The nearest corner counts, not the middle.
    EXPECT_EQ(widthAt(1, "eye = [72.1, 62, 16]\nlook_at = [16, 16, 16]\nfov = 90"), 1);
    EXPECT_EQ(widthAt(1, "eye = [32, 82.1, 16]\nlook_at = [32, 0, 16]\nup = [1, 0, 0]\nfov = 90"),
              1);
    // A pixel of an orthographic camera is as wide from everywhere.
    const std::string parallel =
        "type = \"orthographic\"\neye = [16, 16, 16]\nlook_at = [0, 16, 16]\n";
    EXPECT_EQ(widthAt(1, parallel + "height = 199"), 1);
    EXPECT_EQ(widthAt(1, parallel + "height = 201"), 2);
}

TEST(LevelOfDetail, SaysWhatItDid) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {cube("density", stripes)});
    const Built coarse = build(dir, "scale = 1", 1, cameraAt(101));
    ASSERT_EQ(coarse.notes.size(), 1u);
    EXPECT_EQ(coarse.notes[0],
              fmt::format("level of detail: grid 'density' in {}: voxels 4 times as wide, now 0.99 "
                          "pixels",
                          (dir / "a.vdb").string()));
    EXPECT_TRUE(build(dir, "scale = 1", 1, cameraAt(20)).notes.empty());
    EXPECT_TRUE(build(dir, "scale = 1", 0, cameraAt(1e4)).notes.empty());
}

/// Everything that a volume reads becomes coarse and stays in place; albedos go by density.
TEST(LevelOfDetail, CoarsensEveryGridInPlace) {
    const TempDir dir;
    const auto ramp = [](Vec3i v) { return 1 + 0.125 * v.x + 0.25 * v.y; };
    GridSpec albedo = cube("albedo", nullptr);
    albedo.type = VdbType::Vec3s;
    albedo.value = nullptr;
    albedo.colour = [](Vec3i v) { return v.x & 2 ? Vec3d{0.5, 0.25, 1} : Vec3d{0.125, 1, 1}; };
    writeVdb(dir / "a.vdb",
             {cube("density", stripes), cube("flame", ramp), cube("other", ramp), albedo});
    const Vec3d p{15.75, 16.25, 16.25};  // where four, and eight, voxels meet
    const Built emitting =
        build(dir, "scale = 1\nalbedo_grid = \"albedo\"\nemission = { grid = \"flame\" }", 1,
              cameraAt(101));
    EXPECT_EQ(emitting.notes.size(), 3u);
    const Medium& medium = emitting.scene.medium;
    EXPECT_EQ(voxelWidth(medium.parts[0]), 2);
    EXPECT_FLOAT_EQ(medium.parts[0].sigmaT(p)[0], 1.5f);
    const Rgb scattered = medium.parts[0].sigmaS(p);
    EXPECT_FLOAT_EQ(scattered[0], 1.5f * (0.5f * 2 + 0.125f) / 3);
    EXPECT_FLOAT_EQ(scattered[1], 1.5f * (0.25f * 2 + 1) / 3);
    EXPECT_FLOAT_EQ(medium.emission[0].value(p)[0],
                    static_cast<float>(1 + 0.125 * p.x * 2 + 0.25 * p.y * 2));
    const Built separate = build(dir,
                                 "sigma_a = { grid = \"other\" }\n"
                                 "sigma_s = { grid = \"other\", scale = 2 }\n"
                                 "blackbody = { temperature = \"flame\", scale = 1000 }\n",
                                 1, cameraAt(101));
    ASSERT_EQ(separate.scene.medium.parts.size(), 1u);  // still one grid
    EXPECT_EQ(voxelWidth(separate.scene.medium.parts[0]), 2);
    EXPECT_EQ(length(separate.scene.medium.emission[0].description().worldFromIndex.column[1]), 2);
}

/// Exp is convex: lumps that differ let more through than their means. Of 16 lumps along a ray,
/// each of optical depth 0 or 0.06, the depth varies by 0.12: that is half its square, or 0.7 %,
/// behind the medium, which fills less than half of the picture.
TEST(LevelOfDetail, ChangesLittleFromFarAway) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {cube("density", [](Vec3i v) {
                 return hashOf(v.x / 4, v.y / 4, v.z / 4) & 1 ? 0.03 : 0.0;
             })});
    const std::string camera =
        "type = \"orthographic\"\nheight = 40\neye = [99, 16, 16]\nlook_at = [0, 16, 16]";
    const auto passed = [&](double pixels) {
        const Built b = build(dir, "sigma_a = 1", pixels, camera);
        EXPECT_EQ(voxelWidth(b.scene.medium.parts[0]), pixels > 0 ? 4 : 0.5);
        return meanOverSeeds(b.scene, {.width = 60, .height = 40, .samples = 16}, 8)[0];
    };
    const Estimate fine = passed(0), coarse = passed(10);
    EXPECT_LT(fine.mean, 0.9);
    EXPECT_NEAR(coarse.mean, fine.mean, 0.005 * fine.mean);
    EXPECT_LT(std::hypot(fine.error, coarse.error), 0.001);
}

}  // namespace
}  // namespace woodcock::test
