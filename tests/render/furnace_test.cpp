// SPDX-License-Identifier: Apache-2.0
// Nothing that scatters without loss shows in even light: every pixel is the light.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "tests/support/paths.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

class Furnace : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(teapot)) GTEST_SKIP() << "no " << teapot;
    }

    std::string volume(const std::string& lines) const {
        return fmt::format("[[volume]]\nfile = '{}'\n{}\n", teapot.string(), lines);
    }

    const std::filesystem::path teapot = sharedDir() / "assets" / "teapot_cloud.vdb";
    const std::string camera = "[camera]\neye = [0, 0.4, 3.4]\nlook_at = [0, 0.05, 0]\nfov = 40\n";
    const std::string even = "[[light]]\ntype = \"environment\"\nradiance = [0.5, 0.5, 0.5]\n";
    const std::string dense = volume("scale = 8\ng = 0.85");
};

TEST_F(Furnace, DenseCloud) {
    const Scene scene = sceneFrom(dense + even + camera);
    expectAgrees(meanOverSeeds(scene, {48, 48, 4}, 16), {0.5, 0.5, 0.5}, 5e-4);
    // There is a cloud in the picture.
    EXPECT_GT(renderScene(scene, {48, 48, 4}).film.alpha(24, 24), 0.9);
}

/// Every path of a grey medium without absorption carries all of the light, as long as Russian
/// roulette does not see thousands of scatterings: no noise at all.
TEST_F(Furnace, EveryPixelOfAGreyCloudIsTheLight) {
    const std::string inside = "[camera]\neye = [0, 0.1, 0]\nlook_at = [1, 0, 0.3]\nfov = 90\n";
    for (const std::string& view : {camera, inside}) {
        const Scene scene = sceneFrom(volume("scale = 1\ng = 0.5") + even + view);
        const Film film = renderScene(scene, {48, 48, 4}).film;
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 48; ++x) EXPECT_EQ(film.radiance(x, y)[0], 0.5f) << x << ", " << y;
    }
}

/// The same light as an image is found by next-event estimation and by scattering, in shares.
TEST_F(Furnace, NextEventEstimationAndScatteringShareTheLight) {
    const TempDir dir;
    writeFloats(dir / "sky.exr", 8, 4, 3, std::vector<float>(8 * 4 * 3, 0.5f));
    const std::string image = "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n";
    const Scene scene = sceneFrom(dense + image + camera, dir.path());
    expectAgrees(meanOverSeeds(scene, {48, 48, 4}, 32), {0.5, 0.5, 0.5}, 5e-4);
}

/// So do several, each of which is picked with a probability of its own.
TEST(FurnaceOfABox, UnequalImagesShareTheLight) {
    const TempDir dir;
    std::string lights;
    for (const float radiance : {0.3f, 0.1f}) {
        const std::string name = fmt::format("sky{}.exr", radiance);
        writeFloats(dir / name, 8, 4, 3, std::vector<float>(8 * 4 * 3, radiance));
        lights += fmt::format("[[light]]\ntype = \"environment\"\nimage = \"{}\"\n", name);
    }
    const std::string box =
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0\nsigma_s = 2\n"
        "g = 0.5\n";
    const std::string camera = "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nfov = 30\n";
    const Scene scene = sceneFrom(box + lights + camera, dir.path());
    expectAgrees(meanOverSeeds(scene, {32, 32, 16}, 16), {0.4, 0.4, 0.4}, 1e-3);
}

/// From the middle of a conservative box many paths scatter often enough to meet the roulette that
/// bounds their number.
TEST(FurnaceOfABox, ThousandsOfScatteringsLoseNothing) {
    const Scene scene = sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0\nsigma_s = 100\n"
        "[[light]]\ntype = \"environment\"\nradiance = 1\n"
        "[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1]\nfov = 30\n");
    expectAgrees(meanOverSeeds(scene, {8, 8, 2}, 16), {1, 1, 1}, 0.02);
}

TEST_F(Furnace, OverlappingChromaticRotatedPair) {
    const std::string pair = volume("sigma_s = [0.8, 0.5, 0.3]\ng = 0.85") +
                             volume(
                                 "sigma_s = [0.1, 0.2, 0.4]\ng = -0.3\n"
                                 "transform = { rotate = [20, 70, -35], scale = [0.8, -1.1, 0.6], "
                                 "translate = [0.3, 0.1, 0.1] }");
    const Scene scene = sceneFrom(pair + even + camera);
    expectAgrees(meanOverSeeds(scene, {48, 48, 96}, 16), {0.5, 0.5, 0.5}, 5e-4);
}

/// Three channels with nothing to tell them apart but the light: rounding only.
TEST_F(Furnace, ColouredLight) {
    const std::string red = "[[light]]\ntype = \"environment\"\nradiance = [2, 0, 0.25]\n";
    const Film film =
        renderScene(sceneFrom(volume("scale = 1\ng = 0.5") + red + camera), {32, 32, 4}).film;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const Rgb light = film.radiance(x, y);
            EXPECT_NEAR(light[0], 2, 2e-4);
            EXPECT_EQ(light[1], 0);
            EXPECT_NEAR(light[2], 0.25, 3e-5);
        }
}

/// The comparisons above can tell: one percent of absorption is no furnace.
TEST_F(Furnace, LossMakesItDarker) {
    const Scene scene = sceneFrom(volume("scale = 8\nalbedo = 0.99\ng = 0.85") + even + camera);
    const Estimate e = meanOverSeeds(scene, {32, 32, 4}, 8)[0];
    EXPECT_LT(e.mean + 4 * e.error, 0.5 * 0.99);
}

}  // namespace
}  // namespace woodcock::test
