// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/render/path_tracer.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

const std::string fog = "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n";

/// Bright samples are rare here, and coloured.
Scene localLightInFog() {
    return sceneFrom(fog +
                     "sigma_a = 0.1\nsigma_s = [1, 2, 0.5]\ng = 0.5\n"
                     "[[light]]\ntype = \"sphere\"\nposition = [-0.5, 0.2, 0]\nradius = 0.1\n"
                     "radiance = [30, 20, 10]\n"
                     "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 30\n");
}

/// Every sample of a small picture.
struct Samples {
    std::vector<PathResult> results;
    std::uint64_t clamped;
};
Samples trace(const Scene& scene, double clamp) {
    PathTracer::Options options;
    options.width = options.height = 16;
    options.approximations.clamp = clamp;
    std::vector<PathJob> jobs;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            for (std::uint32_t s = 0; s < 32; ++s) jobs.push_back({x, y, s});
    std::vector<PathResult> results(jobs.size());
    const auto tracer = PathTracer::make(scene, findNeeds(scene), options);
    RenderCounters counters;
    EXPECT_TRUE(tracer->trace(
        jobs, results, [] { return false; }, counters));
    return {std::move(results), counters.clamped};
}

TEST(Clamp, ScalesWhatIsBrighterAndLeavesTheRest) {
    const float most = 0.5f;
    const Scene scene = localLightInFog();
    const Samples free = trace(scene, 0), clamped = trace(scene, most);
    std::uint64_t brighter = 0;
    for (std::size_t i = 0; i < free.results.size(); ++i) {
        const FilmSample &f = free.results[i].film, &c = clamped.results[i].film;
        EXPECT_EQ(f.alpha, c.alpha);
        const float brightest = f.radiance.maximum();
        if (brightest <= most) {
            EXPECT_EQ(f.radiance, c.radiance);
            continue;
        }
        ++brighter;
        EXPECT_FLOAT_EQ(c.radiance.maximum(), most);
        for (int k = 0; k < 3; ++k)
            EXPECT_FLOAT_EQ(c.radiance[k] * brightest, f.radiance[k] * most);
    }
    EXPECT_EQ(clamped.clamped, brighter);
    EXPECT_GT(brighter, 100u);
    EXPECT_LT(brighter, free.results.size() / 2);
    EXPECT_EQ(free.clamped, 0u);
}

TEST(Clamp, BeyondAllSamplesChangesNothing) {
    const Scene scene = localLightInFog();
    const Samples free = trace(scene, 0), wide = trace(scene, 1e6);
    for (std::size_t i = 0; i < free.results.size(); ++i)
        EXPECT_EQ(free.results[i].film.radiance, wide.results[i].film.radiance);
    EXPECT_EQ(wide.clamped, 0u);
}

/// A path that may not scatter brings the sky's radiance with the probability exp(-2), else none:
/// clamped, it brings no more than the bound.
TEST(Clamp, GivesTheExpectationOfTheLesser) {
    const Scene scene = sceneFrom(fog +
                                  "sigma_a = 0\nsigma_s = 1\n"
                                  "[[light]]\ntype = \"environment\"\nradiance = [2, 4, 1]\n" +
                                  pencilCamera({0, 0, 5}, {0, 0, -1}));
    RenderSettings settings;
    settings.width = settings.height = 32, settings.endSample = 64;
    settings.maxScatterings = 0;
    settings.approximations.clamp = 1;
    const RenderResult result = render::render(scene, settings);
    const double t = std::exp(-2.0);
    expectAgrees(evenRadiance(result.film), {0.5 * t, t, 0.25 * t}, 1e-2);
    const double paths = 32 * 32 * 64;
    EXPECT_NEAR(static_cast<double>(result.counters.clamped) / paths, t,
                4 * std::sqrt(t * (1 - t) / paths));
}

}  // namespace
}  // namespace woodcock::test
