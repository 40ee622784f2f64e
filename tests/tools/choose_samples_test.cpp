// SPDX-License-Identifier: Apache-2.0
#include "tools/render/choose_samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace woodcock::test {

using namespace tool;

namespace {

/// A trial of 16 samples a pixel, half of them 1 + `scatter` and half 1 - `scatter`, whose paths
/// take so many steps.
render::RenderResult trial(float scatter, std::uint64_t stepsOfPath) {
    constexpr int width = 12, height = 9, samples = 16;
    render::RenderResult result{{image::Film(width, height, {0, 0, width, height})}, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int i = 0; i < samples; ++i)
                result.film.add(
                    x, y, {.radiance = Rgb(1 + (i % 2 == 0 ? scatter : -scatter)), .alpha = 1});
    result.counters.paths = width * height * samples;
    result.counters.distanceSegments = result.counters.paths * stepsOfPath / 4;
    result.counters.distanceCollisions = result.counters.shadowSegments =
        result.counters.shadowCollisions = result.counters.distanceSegments;
    return result;
}

TEST(ChooseSamples, TakesThoseThatAGoodNoiseNeeds) {
    // A sample's standard deviation is 0.2 sqrt(16 / 15), and the noise falls with the root.
    const render::RenderResult thin = trial(0.2f, 4);
    const ChosenSamples chosen = chooseSamples(thin);
    const double ofOne = thin.film.noise() * 4;
    EXPECT_NEAR(ofOne, 0.2 * std::sqrt(16 / 15.0), 0.002);
    EXPECT_EQ(chosen.perPixel, std::floor(std::pow(ofOne / goodNoise, 2)));
    EXPECT_NEAR(chosen.noise, goodNoise, 0.02 * goodNoise);
    EXPECT_FALSE(chosen.limited);
    EXPECT_EQ(describe(chosen), "chosen for a noise of about 4 %");
}

TEST(ChooseSamples, TakesNoMoreWorkThanAMinuteHolds) {
    const ChosenSamples chosen = chooseSamples(trial(0.9f, 100));
    EXPECT_EQ(chosen.perPixel, mostWork / 100);
    EXPECT_NEAR(chosen.noise, 0.9 * std::sqrt(16 / 15.0 / chosen.perPixel), 0.002);
    EXPECT_TRUE(chosen.limited);
    EXPECT_NE(describe(chosen).find("under a minute on two cores at 960 x 540, for a noise"),
              std::string::npos);
}

TEST(ChooseSamples, KeepsToTheirBounds) {
    EXPECT_EQ(chooseSamples(trial(0, 4)).perPixel, 4);           // no noise at all
    EXPECT_EQ(chooseSamples(trial(0.9f, 1000000)).perPixel, 4);  // endless work
    // Of nothing that shines the noise is unknown, and it takes no work.
    const render::RenderResult nothing{{image::Film(9, 9, {0, 0, 9, 9})}, {}};
    EXPECT_EQ(chooseSamples(nothing).perPixel, 1024);
    EXPECT_EQ(describe(chooseSamples(nothing)), "chosen for an unknown noise");
}

}  // namespace
}  // namespace woodcock::test
