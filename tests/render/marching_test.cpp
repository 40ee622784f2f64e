// SPDX-License-Identifier: Apache-2.0
// Pictures of media that are marched instead of tracked.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "tests/support/expect_estimate.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

RenderSettings settingsOf(int size, int samples, double step, bool jackknife = true) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.endSample = samples;
    settings.approximations.marchStep = step;
    settings.approximations.jackknife = jackknife;
    return settings;
}

const std::vector<double> layered{5, 0, 1, 0.125, 0, 0, 8, 3, 0.5, 2, 0, 4};

Scene slab(const proof::Lab& lab, double depth, double albedo, double g,
           const std::string& light = proof::twoColouredSky) {
    proof::writeTwoColouredSky(lab);
    proof::writeSlab(lab, "slab.vdb", layered);
    return sceneFrom(
        fmt::format("[[volume]]\nfile = \"slab.vdb\"\nscale = {}\nalbedo = {}\ng = {}\n{}{}", depth,
                    albedo, g, light, proof::cameraAbove(1)),
        lab.directory());
}

/// Adding-doubling with 64 nodes per hemisphere, as in slab_test.cpp.
TEST(MarchedPicture, FineStepsReflectAndTransmitAsASlabDoes) {
    const proof::Lab lab({});
    const auto answer = [&](double depth, double albedo, double g, double step, bool jackknife) {
        const Scene scene = slab(lab, depth, albedo, g);
        return evenRadiance(render::render(scene, settingsOf(32, 192, step, jackknife)).film);
    };
    const RgbEstimate thin = answer(1, 0.9, 0.5, 0.5, true);
    expectAgrees(thin[0], .129793, 5e-3);
    expectAgrees(thin[2], .739091, 5e-3);
    const RgbEstimate thick = answer(2, 0.9, 0.75, 0.25, true);
    expectAgrees(thick[0], .097395, 5e-3);
    expectAgrees(thick[2], .660958, 5e-3);
    // The comparison can tell: one look-up for eight layers lets too much through.
    EXPECT_GT(answer(2, 0.9, 0.75, 1000, false)[2].mean, 1.02 * .660958);
}

/// Nothing that scatters without loss shows in even light, whatever the step.
TEST(MarchedPicture, EveryPixelOfAGreySlabIsTheLight) {
    const proof::Lab lab({});
    const Scene scene =
        slab(lab, 3, 1, 0.5, "[[light]]\ntype = \"environment\"\nradiance = [0.5, 0.5, 0.5]\n");
    for (double step : {0.3, 1000.0}) {
        const Film film = render::render(scene, settingsOf(8, 4, step)).film;
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) EXPECT_EQ(film.radiance(x, y)[0], 0.5f) << x << ", " << y;
    }
}

const std::string bowl =
    "[[material]]\nname = \"clear\"\ntype = \"dielectric\"\nior = 1.2\n"
    "[[surface]]\nmaterial = \"clear\"\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
    "medium = { sigma_a = [0.1, 0.3, 0.5], sigma_s = [1, 0.5, 0.2] }\n"
    "[[light]]\ntype = \"environment\"\nradiance = [1, 1, 1]\n"
    "[camera]\neye = [0, 1, 6]\nlook_at = [0, 0, 0]\n";

/// Homogeneous media have no steps: marched by chance of another kind, the same in the mean.
TEST(MarchedPicture, WithinSurfacesIsExactWhereMediaAreHomogeneous) {
    const Scene scene = sceneFrom(bowl);
    const auto mean = [&](double step) {
        std::array<Moments, 3> seeds;
        for (std::uint64_t seed = 0; seed < 24; ++seed) {
            RenderSettings settings = settingsOf(16, 16, step);
            settings.seed = seed;
            const Film film = render::render(scene, settings).film;
            for (int c = 0; c < 3; ++c)
                seeds[static_cast<std::size_t>(c)].add(meanRadiance(film, c));
        }
        return RgbEstimate{Estimate(seeds[0]), Estimate(seeds[1]), Estimate(seeds[2])};
    };
    expectAgree(mean(1), mean(0), 4e-3);
}

TEST(MarchedPicture, ThreadsLeaveNoTrace) {
    const proof::Lab lab({});
    const Scene scene = slab(lab, 2, 0.9, 0.75);
    RenderSettings settings = settingsOf(24, 4, 0.7);
    settings.threads = 1;
    const Film one = render::render(scene, settings).film;
    settings.threads = 4;
    const Film four = render::render(scene, settings).film;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) EXPECT_EQ(one.radiance(x, y), four.radiance(x, y));
}

TEST(MarchedPicture, RefusesTooManyStepsBeforeItRenders) {
    const proof::Lab lab({});
    const Scene scene = slab(lab, 2, 0.9, 0.75);
    expectError(ErrorKind::Usage, "march_step is 1e-06 voxels",
                [&] { render::render(scene, settingsOf(8, 1, 1e-6)); });
}

}  // namespace
}  // namespace woodcock::test
