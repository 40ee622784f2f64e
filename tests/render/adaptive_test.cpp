// SPDX-License-Identifier: Apache-2.0
// Renders whose samples go where the error is.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/expect_error.h"
#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

/// Fog under a sun fills a fifth of the picture; the rest is exactly black.
Scene sunnyFog(const char* light = "type = \"sun\"\ndirection = [1, -2, 0]\nirradiance = 3\n") {
    return sceneFrom(
        std::string("[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0.1\n"
                    "sigma_s = [1, 2, 0.5]\n") +
        "[[light]]\n" + light + "[camera]\neye = [0, 0.5, 6]\nlook_at = [0, 0, 0]\nfov = 45\n");
}

RenderSettings settings(int samples) {
    RenderSettings s;
    s.width = 41, s.height = 35, s.endSample = samples;
    s.adaptive = true;
    return s;
}

std::uint64_t totalSamples(const Film& film) {
    std::uint64_t total = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) total += film.at(x, y).samples;
    return total;
}

TEST(Adaptive, ThreadsDoNotShow) {
    const Scene scene = sunnyFog();
    RenderSettings s = settings(24);
    s.threads = 1;
    const Film one = render::render(scene, s).film;
    for (const int threads : {2, 3, 0}) {
        s.threads = threads;
        const Film many = render::render(scene, s).film;
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x)
                ASSERT_EQ(std::memcmp(&one.at(x, y), &many.at(x, y), sizeof(Film::Pixel)), 0)
                    << x << ", " << y;
    }
}

/// As SamplePlan counts it.
double workOf(const RenderCounters& c) {
    return static_cast<double>(c.paths) + 10 * static_cast<double>(c.scatterings);
}

TEST(Adaptive, CostsAsMuchWorkAndPutsItWhereTheFogIs) {
    for (const int samples : {1, 2, 3, 24, 100}) {
        RenderSettings s = settings(samples);
        const RenderResult result = render::render(sunnyFog(), s);
        EXPECT_EQ(result.reason, StopReason::Complete);
        EXPECT_EQ(result.endSample, samples);
        EXPECT_EQ(totalSamples(result.film), result.counters.paths);
        EXPECT_DOUBLE_EQ(result.film.meanSamples() * 41 * 35,
                         static_cast<double>(result.counters.paths));
        s.adaptive = false;
        const RenderResult even = render::render(sunnyFog(), s);
        EXPECT_NEAR(workOf(result.counters) / workOf(even.counters), 1, samples < 24 ? 0.1 : 0.03);
        if (samples < 24) continue;
        EXPECT_EQ(result.film.at(0, 0).samples, static_cast<std::uint64_t>(samples / 4));
        EXPECT_EQ(result.film.fewestSamples(), static_cast<std::uint64_t>(samples / 4));
        EXPECT_GT(result.film.at(20, 16).samples, static_cast<std::uint64_t>(samples));
    }
}

TEST(Adaptive, FogGetsAsManySamplesBeforeAHiddenSky) {
    const auto samplesOfFog = [](const char* visible) {
        const Film film =
            render::render(
                sunnyFog(
                    (std::string("type = \"sun\"\ndirection = [1, -2, 0]\nirradiance = 3\n"
                                 "[[light]]\ntype = \"environment\"\nradiance = 0.3\nvisible = ") +
                     visible + "\n")
                        .c_str()),
                settings(64))
                .film;
        Moments fog;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                if (film.alpha(x, y) > 0.5f) fog.add(static_cast<double>(film.at(x, y).samples));
        return fog.mean();
    };
    const double visible = samplesOfFog("true"), hidden = samplesOfFog("false");
    EXPECT_GT(hidden, 64);
    EXPECT_NEAR(hidden / visible, 1, 0.1);
}

TEST(Adaptive, TheMeanIsThatOfEqualSamples) {
    const Scene scene = sunnyFog();
    const auto meanOf = [&](bool adaptive, std::uint64_t firstSeed) {
        Moments means;
        RenderSettings s = settings(8);
        s.adaptive = adaptive;
        for (s.seed = firstSeed; s.seed < firstSeed + 40; ++s.seed)
            means.add(meanRadiance(render::render(scene, s).film, 1));
        return Estimate(means);
    };
    expectAgree(meanOf(true, 0), meanOf(false, 1000), 0.01);
}

TEST(Adaptive, HasTheSmallerRelativeError) {
    const Scene scene = sunnyFog();
    RenderSettings s = settings(1024);
    s.adaptive = false, s.seed = 1000;
    const Film truth = render::render(scene, s).film;
    // Relative to what is seen before a background as bright as the fog, as Film::noise() is.
    double light = 0, covered = 0;
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x)
            light += truth.radiance(x, y)[1], covered += truth.alpha(x, y);
    const double mean = light / covered;
    const auto relMse = [&](bool adaptive) {
        Moments m;
        s.adaptive = adaptive, s.endSample = 32;
        for (s.seed = 0; s.seed < 4; ++s.seed) {
            const Film film = render::render(scene, s).film;
            for (int y = 0; y < s.height; ++y)
                for (int x = 0; x < s.width; ++x) {
                    const double t = truth.radiance(x, y)[1];
                    const double seen = std::hypot(t + (1 - truth.alpha(x, y)) * mean, 0.1 * mean);
                    m.add(std::pow((film.radiance(x, y)[1] - t) / seen, 2));
                }
        }
        return m.mean();
    };
    EXPECT_LT(relMse(true), 0.95 * relMse(false)) << "for equal work";
}

TEST(Adaptive, StopsAtTheNoiseAndAtTheTimeLimit) {
    const Scene scene = sunnyFog("type = \"environment\"\n");
    RenderSettings s = settings(1 << 30);
    s.noise = 0.02;
    const RenderResult quiet = render::render(scene, s);
    EXPECT_EQ(quiet.reason, StopReason::NoiseReached);
    EXPECT_LT(quiet.film.noise(), 0.02);
    EXPECT_GT(quiet.film.noise(), 0.01) << "and not long after it";
    EXPECT_GT(quiet.film.mostSamples(), static_cast<std::uint64_t>(quiet.endSample));
    EXPECT_EQ(totalSamples(quiet.film), quiet.counters.paths);
    s.noise = 0, s.timeLimit = 0.3;
    RenderResult brief = render::render(scene, s);
    // A busy machine may need longer for the first sample.
    for (; brief.film.fewestSamples() == 0; brief = render::render(scene, s)) s.timeLimit *= 4;
    EXPECT_EQ(brief.reason, StopReason::TimeLimit);
}

TEST(Adaptive, RefusesPartsOfASampleRange) {
    RenderSettings s = settings(16);
    s.firstSample = 8;
    expectError(ErrorKind::Usage, "8:16", [&] { render::render(sunnyFog(), s); });
}

}  // namespace
}  // namespace woodcock::test
