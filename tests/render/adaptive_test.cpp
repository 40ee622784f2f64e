// SPDX-License-Identifier: Apache-2.0
// Renders whose samples go where the error is.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/expect_error.h"
#include "tests/support/expect_estimate.h"
#include "tests/support/render_scene.h"

namespace woodcock::test {
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
    const Film one = render(scene, s).film;
    for (const int threads : {2, 3, 0}) {
        s.threads = threads;
        const Film many = render(scene, s).film;
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x)
                ASSERT_EQ(std::memcmp(&one.at(x, y), &many.at(x, y), sizeof(Film::Pixel)), 0)
                    << x << ", " << y;
    }
}

TEST(Adaptive, CostsAsManySamplesAndPutsThemWhereTheFogIs) {
    for (const int samples : {1, 2, 3, 24, 100}) {
        const RenderResult result = render(sunnyFog(), settings(samples));
        EXPECT_EQ(result.reason, StopReason::Complete);
        EXPECT_EQ(result.endSample, samples);
        EXPECT_EQ(result.counters.paths, static_cast<std::uint64_t>(41 * 35 * samples));
        EXPECT_EQ(totalSamples(result.film), result.counters.paths);
        if (samples < 24) continue;
        EXPECT_EQ(result.film.at(0, 0).samples, static_cast<std::uint64_t>(samples / 4));
        EXPECT_GT(result.film.at(20, 16).samples, 2 * result.film.at(0, 0).samples);
        EXPECT_GT(result.film.mostSamples(), static_cast<std::uint64_t>(3 * samples));
    }
}

TEST(Adaptive, TheMeanIsThatOfEqualSamples) {
    const Scene scene = sunnyFog();
    const auto meanOf = [&](bool adaptive, std::uint64_t firstSeed) {
        Moments means;
        RenderSettings s = settings(8);
        s.adaptive = adaptive;
        for (s.seed = firstSeed; s.seed < firstSeed + 40; ++s.seed)
            means.add(meanRadiance(render(scene, s).film, 1));
        return Estimate(means);
    };
    expectAgree(meanOf(true, 0), meanOf(false, 1000), 0.01);
}

TEST(Adaptive, HasTheSmallerRelativeError) {
    const Scene scene = sunnyFog();
    RenderSettings s = settings(1024);
    s.adaptive = false, s.seed = 1000;
    const Film truth = render(scene, s).film;
    const double mean = meanRadiance(truth, 1);
    const auto relMse = [&](bool adaptive) {
        Moments m;
        s.adaptive = adaptive, s.endSample = 32;
        for (s.seed = 0; s.seed < 4; ++s.seed) {
            const Film film = render(scene, s).film;
            for (int y = 0; y < s.height; ++y)
                for (int x = 0; x < s.width; ++x) {
                    const double t = truth.radiance(x, y)[1];
                    m.add(std::pow(film.radiance(x, y)[1] - t, 2) / (t * t + 0.01 * mean * mean));
                }
        }
        return m.mean();
    };
    EXPECT_LT(relMse(true), 0.8 * relMse(false));
}

TEST(Adaptive, StopsAtTheNoiseAndAtTheTimeLimit) {
    const Scene scene = sunnyFog("type = \"environment\"\n");
    RenderSettings s = settings(1 << 30);
    s.noise = 0.005;
    const RenderResult quiet = render(scene, s);
    EXPECT_EQ(quiet.reason, StopReason::NoiseReached);
    EXPECT_LT(quiet.film.noise(), 0.005);
    EXPECT_GT(quiet.film.mostSamples(), static_cast<std::uint64_t>(quiet.endSample));
    EXPECT_EQ(totalSamples(quiet.film), static_cast<std::uint64_t>(41 * 35 * quiet.endSample));
    s.noise = 0, s.timeLimit = 0.3;
    const RenderResult brief = render(scene, s);
    EXPECT_EQ(brief.reason, StopReason::TimeLimit);
    EXPECT_GE(totalSamples(brief.film), static_cast<std::uint64_t>(41 * 35 * brief.endSample));
}

TEST(Adaptive, RefusesPartsOfASampleRange) {
    RenderSettings s = settings(16);
    s.firstSample = 8;
    expectError(ErrorKind::Usage, "8:16", [&] { render(sunnyFog(), s); });
}

}  // namespace
}  // namespace woodcock::test
