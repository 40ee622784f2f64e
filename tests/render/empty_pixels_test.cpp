// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/empty_pixels.h"

#include <gtest/gtest.h>

#include "woodcock/base/temp_dir.h"
#include "woodcock/proof/support/plain_medium.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;
using namespace render;

namespace {

constexpr int width = 48, height = 40;

/// Two balls of voxels, apart from each other, before an even background.
Scene twoBalls(const std::string& more = "") {
    Scene scene = sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 1\n"
        "[[light]]\ntype = \"environment\"\nradiance = [0.3, 0.4, 0.5]\n"
        "[[light]]\ntype = \"sun\"\ndirection = [0.5, -1, -0.3]\nirradiance = 2\n"
        "angular_diameter = 0\n"
        "[camera]\neye = [0, 2, 40]\nlook_at = [0, 0, 0]\nfov = 30\n" +
        more);
    const auto ball = [](Vec3d at) {
        return PlainPart{.grid = mixedGrid(3),
                         .worldFromIndex = Affine3d::translate(at) * Affine3d::rotate(2, 20) *
                                           Affine3d::scale({0.3, 0.2, 0.3}),
                         .scattering = Rgb(0.5f)};
    };
    scene.medium = PlainMedium({ball({-5, 1, 0}), ball({3, -4, 2})}).medium();
    return scene;
}

PathTracer::Options options() {
    PathTracer::Options options;
    options.width = width, options.height = height;
    return options;
}

std::vector<PathResult> trace(const Scene& scene, const PathTracer::Options& options) {
    std::vector<PathJob> jobs;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::uint32_t sample = 0; sample < 8; ++sample) jobs.push_back({x, y, sample});
    std::vector<PathResult> results(jobs.size());
    RenderCounters counters;
    EXPECT_TRUE(PathTracer::make(scene, findNeeds(scene), options)
                    ->trace(
                        jobs, results, [] { return false; }, counters));
    EXPECT_EQ(counters.paths, jobs.size());
    return results;
}

/// A picture with its empty pixels and one without them. Returns the share of those that are empty.
double expectSameBits(const Scene& scene) {
    PathTracer::Options with = options();
    const EmptyPixels empty(scene, findNeeds(scene), with);
    with.emptyPixels = &empty;
    const auto traced = trace(scene, options()), quick = trace(scene, with);
    double holds = 0;
    for (std::size_t i = 0; i < traced.size(); ++i) {
        const auto pixel = static_cast<int>(i / 8);
        holds += empty.holds(pixel % width, pixel / width);
        EXPECT_EQ(traced[i].film.radiance, quick[i].film.radiance);
        EXPECT_EQ(traced[i].film.background, quick[i].film.background);
        EXPECT_EQ(traced[i].film.alpha, quick[i].film.alpha);
        EXPECT_EQ(traced[i].film.events, quick[i].film.events);
    }
    return holds / static_cast<double>(traced.size());
}

TEST(EmptyPixels, ChangeNoBit) {
    Scene scene = twoBalls();
    const double share = expectSameBits(scene);
    EXPECT_GT(share, 1 / 3.0);  // also between the balls
    EXPECT_LT(share, 1);
    scene.camera = camera::Camera::orthographic({0, 2, 40}, {}, {0, 1, 0}, 16);
    EXPECT_GT(expectSameBits(scene), 1 / 3.0);
}

TEST(EmptyPixels, AreNotWhereSomethingGlows) {
    Scene scene = twoBalls();
    const double dark = expectSameBits(scene);
    scene.medium.emission.emplace_back(medium::EmissionPart::Description{
        .field = scene.medium.parts[0].description().field,
        .box = {},
        .worldFromIndex = Affine3d::translate({5, 4, 0}) * Affine3d::scale({0.3, 0.2, 0.3}),
        .scale = Rgb(0.1f)});
    const double glowing = expectSameBits(scene);
    EXPECT_GT(glowing, 0.2);
    EXPECT_LT(glowing, dark - 0.02);
}

/// Where a grid's background is not zero, the medium reaches to the limits of the grid.
TEST(EmptyPixels, AreNotWhereABackgroundIs) {
    const TempDir dir;
    GridSpec grid;
    grid.background = {0.5, 0, 0};
    grid.box = {{-20, 0, 0}, {20, 3, 3}};
    grid.value = [](Vec3i v) { return std::abs(v.x) > 16 ? 1 : 0.5; };
    writeVdb(dir / "ends.vdb", {grid});
    const Scene scene = sceneFrom(
        "[[volume]]\nfile = \"ends.vdb\"\nsigma_s = 0.2\n"
        "[[light]]\ntype = \"environment\"\nradiance = [0.3, 0.4, 0.5]\n"
        "[camera]\neye = [0, 2, 80]\nlook_at = [0, 0, 0]\nfov = 40\n",
        dir.path());
    ASSERT_TRUE(scene.medium.parts[0].limits());
    EXPECT_GT(expectSameBits(scene), 0.2);
}

TEST(EmptyPixels, AreNoneWhereTheBackgroundVariesOrMoreIsAskedFor) {
    const auto any = [](const Scene& scene, const PathTracer::Options& options) {
        const EmptyPixels empty(scene, findNeeds(scene), options);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (empty.holds(x, y)) return true;
        return false;
    };
    EXPECT_TRUE(any(twoBalls(), options()));
    EXPECT_FALSE(any(twoBalls("[[light]]\ntype = \"environment\"\nradiance = 1\nabove = 2\n"
                              "below = 0.1\n"),
                     options()));
    PathTracer::Options deep = options();
    deep.stoppedLight = true;
    EXPECT_FALSE(any(twoBalls(), deep));
    Scene inside = twoBalls();
    inside.camera = camera::Camera::perspective({-5, 1, 0}, {0, 0, 0}, {0, 1, 0}, 40);
    EXPECT_FALSE(any(inside, options()));
}

}  // namespace

}  // namespace woodcock::test
