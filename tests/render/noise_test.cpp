// SPDX-License-Identifier: Apache-2.0
// The noise in one number, of renders: the truth, and what has no say in it.
#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

/// A ball of smoke in a box's fog under a sun, before a sky. `height`: of the picture, where the
/// smoke is 2 wide.
Scene smoke(const std::string& sky, double height = 3, const std::string& volume = "") {
    return sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n" +
        (volume.empty() ? std::string("sigma_a = 0.1\nsigma_s = [1, 2, 1.5]\n") : volume) +
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, -1]\nirradiance = 3\n"
        "[[light]]\ntype = \"environment\"\n" +
        sky + "[camera]\ntype = \"orthographic\"\neye = [0.3, 0.5, 6]\nlook_at = [0, 0, 0]\n" +
        "height = " + std::to_string(height) + "\n");
}

double noiseOf(const Scene& scene, int size, int samples = 16, std::uint64_t seed = 0) {
    RenderSettings s;
    s.width = s.height = size, s.endSample = samples, s.seed = seed;
    return render::render(scene, s).film.noise();
}

TEST(Noise, IsTheSameWithAHiddenSky) {
    const double noise = noiseOf(smoke("radiance = 0.7\n"), 32);
    EXPECT_GT(noise, 0.05);
    EXPECT_DOUBLE_EQ(noiseOf(smoke("radiance = 0.7\nvisible = false\n"), 32), noise);
}

TEST(Noise, IsTheSameInAWideAndANarrowFrame) {
    // The same pixels' size; other pixels have other random numbers.
    Moments narrow, wide;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        narrow.add(noiseOf(smoke("radiance = 0.7\n", 3), 36, 16, seed));
        wide.add(noiseOf(smoke("radiance = 0.7\n", 12), 144, 16, seed));
    }
    const Estimate n(narrow), w(wide);
    EXPECT_LT(std::hypot(n.error, w.error), 0.01 * n.mean);
    EXPECT_NEAR(w.mean / n.mean, 1, 4 * std::hypot(n.error, w.error) / n.mean);
}

/// `samples` single samples of as many seeds: independent of each other, as those of one render
/// are not, whose points are spread evenly.
Film independentSamples(const Scene& scene, int size, int samples, std::uint64_t firstSeed) {
    RenderSettings s;
    s.width = s.height = size, s.endSample = 1, s.seed = firstSeed;
    Film film = render::render(scene, s).film;
    for (int i = 1; i < samples; ++i) {
        ++s.seed;
        film.merge(render::render(scene, s).film);
    }
    return film;
}

/// By the definition, from the scatter of many pictures: nothing of the pictures' own estimates.
double trueNoise(const std::vector<Film>& films) {
    const int size = films.front().width();
    std::vector<double> light, coverage, variance;
    double covered = 0, all = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            Moments brightness, alpha;
            std::array<Moments, 3> channels;
            for (const Film& film : films) {
                for (int c = 0; c < 3; ++c)
                    channels[static_cast<std::size_t>(c)].add(film.radiance(x, y)[c]);
                brightness.add(film.radiance(x, y).mean());
                alpha.add(film.alpha(x, y));
            }
            light.push_back(brightness.mean()), coverage.push_back(alpha.mean());
            variance.push_back(
                (channels[0].variance() + channels[1].variance() + channels[2].variance()) / 3);
            covered += coverage.back(), all += light.back();
        }
    const double mean = all / covered;
    double errors = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double seen = std::hypot(light[i] + (1 - coverage[i]) * mean, 0.1 * mean);
        errors += coverage[i] * variance[i] / (seen * seen);
    }
    return std::sqrt(errors / covered);
}

TEST(Noise, IsTheTrueErrorOfWhatIsSeen) {
    for (const char* volume : {"", "sigma_s = 8\ng = 0.7\n", "sigma_s = 0.2\n"}) {
        const Scene scene = smoke("radiance = 0.7\nvisible = false\n", 3, volume);
        std::vector<Film> films;
        Moments told;
        for (std::uint64_t k = 0; k < 32; ++k) {
            films.push_back(independentSamples(scene, 24, 12, 100 * k));
            told.add(films.back().noise());
        }
        // 200 pixels and more that count, of which each knows its variance to a quarter.
        EXPECT_NEAR(told.mean() / trueNoise(films), 1, 0.06) << volume;
    }
}

TEST(Noise, OfFireAndOfFogAroundTheCamera) {
    // A grey glow of which each flight looks at one point: a single sample's deviation is about its
    // mean, whatever is covered.
    const double fire =
        noiseOf(smoke("radiance = 0\n", 3, "sigma_a = 0.02\nemission = 1\n"), 24, 64);
    EXPECT_GT(fire, 0);
    EXPECT_LT(fire, 0.2);
    const Scene inside = sceneFrom(
        "[[volume]]\nbox = { min = [-9, -9, -9], max = [9, 9, 9] }\nsigma_s = 1.5\n"
        "[[light]]\ntype = \"environment\"\n[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1]\n");
    EXPECT_GE(noiseOf(inside, 8), 0);
    EXPECT_LT(noiseOf(inside, 8), 5e-3) << "a furnace";
}

TEST(Noise, EndsARenderOfNothing) {
    RenderSettings s;
    s.width = s.height = 16, s.endSample = 1 << 30, s.noise = 0.01;
    const Scene nothing = sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 1\n"
        "[[light]]\ntype = \"environment\"\n[camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 99]\n");
    const RenderResult result = render::render(nothing, s);
    EXPECT_EQ(result.reason, StopReason::NoiseReached);
    EXPECT_EQ(result.film.noise(), 0);
}

}  // namespace
}  // namespace woodcock::test
