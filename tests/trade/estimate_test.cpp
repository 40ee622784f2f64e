// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "woodcock/base/statistics.h"

namespace woodcock::test {

using namespace trade;

namespace {

constexpr std::size_t pixels = 200;

/// Pictures of value `mean` with Gaussian noise, one for each seed.
std::vector<Pixels> pictures(std::mt19937& random, std::size_t seeds, double mean, double sigma) {
    std::normal_distribution<double> noise(mean, sigma);
    std::vector<Pixels> all(seeds, Pixels(3 * pixels));
    for (Pixels& picture : all)
        for (float& v : picture) v = static_cast<float>(noise(random));
    return all;
}

/// Each number counts 1 / (numbers): what is weighted is a plain mean.
std::vector<double> evenWeights() { return std::vector<double>(3 * pixels, 1.0 / (3 * pixels)); }

// Noise of 0.5 in each picture, of which four and eight stand against each other: their means'
// variances, 0.06 and 0.03, would drown a squared bias of 0.01 or stand for one where there is
// none.
TEST(SquaredBias, IsRightInTheMeanWithoutAFloorOfNoise) {
    for (const double bias : {0.0, 0.1}) {
        std::mt19937 random(1);
        Moments estimates, errors;
        for (int trial = 0; trial < 400; ++trial) {
            const SeedMean a = meanOfSeeds(pictures(random, 4, 1 + bias, 0.5));
            const SeedMean b = meanOfSeeds(pictures(random, 8, 1, 0.5));
            const Measured square = squaredBias(a, b, evenWeights());
            estimates.add(square.value), errors.add(square.se);
        }
        EXPECT_NEAR(estimates.mean(), bias * bias, 4 * estimates.standardError());
        EXPECT_LT(estimates.standardError(), 5e-4);
        // It says itself how far it is off: the scatter of a standard deviation over 400 trials
        // is 4 %.
        EXPECT_NEAR(errors.mean() / std::sqrt(estimates.variance()), 1, 0.15);
    }
}

TEST(SquaredBias, OfPicturesWithoutNoiseIsExact) {
    const std::vector<Pixels> a(2, Pixels(3 * pixels, 1.25f)), b(3, Pixels(3 * pixels, 1));
    const Measured square = squaredBias(meanOfSeeds(a), meanOfSeeds(b), evenWeights());
    EXPECT_DOUBLE_EQ(square.value, 0.0625);
    EXPECT_EQ(square.se, 0);
}

TEST(ErrorsOfSeeds, AreVarianceAndSquaredBiasTogether) {
    std::mt19937 random(2);
    Moments errors, variances;
    for (int trial = 0; trial < 200; ++trial) {
        const std::vector<Pixels> seeds = pictures(random, 4, 1.3, 0.5);
        const SeedMean reference = meanOfSeeds(pictures(random, 4, 1, 0.5));
        errors.add(meanOf(errorsOfSeeds(seeds, reference, evenWeights())).value);
        variances.add(meanOf(variancesOfSeeds(seeds, meanOfSeeds(seeds), evenWeights())).value);
    }
    EXPECT_NEAR(errors.mean(), 0.25 + 0.09, 4 * errors.standardError());
    EXPECT_NEAR(variances.mean(), 0.25, 4 * variances.standardError());
    EXPECT_LT(errors.standardError(), 0.003);
    EXPECT_LT(variances.standardError(), 0.002);
}

TEST(RelativeBias, IsThatOfTheMeanWithItsError) {
    std::mt19937 random(3);
    Moments biases, errors;
    for (int trial = 0; trial < 200; ++trial) {
        const Measured bias = relativeBias(meanOfSeeds(pictures(random, 4, 1.8, 0.5)),
                                           meanOfSeeds(pictures(random, 4, 2, 0.5)));
        biases.add(bias.value), errors.add(bias.se);
    }
    EXPECT_NEAR(biases.mean(), -0.1, 4 * biases.standardError());
    EXPECT_LT(biases.standardError(), 1e-3);
    // Channels are taken to be fully correlated; here they are not, which is the worst case.
    EXPECT_GT(errors.mean() / std::sqrt(biases.variance()), 1);
    EXPECT_LT(errors.mean() / std::sqrt(biases.variance()), 1.9);
}

TEST(RelativeWeights, AreThoseOfRelMse) {
    SeedMean reference;
    reference.mean = {1, 2, 3, 0, 0, 0};  // mean 1: eps = 0.01
    const std::vector<double> weights = relativeWeights(reference);
    EXPECT_DOUBLE_EQ(weights[1], 1 / (6 * (4 + 1e-4)));
    EXPECT_DOUBLE_EQ(weights[4], 1 / (6 * 1e-4));
    reference.mean.assign(6, 0);
    EXPECT_DOUBLE_EQ(relativeWeights(reference)[0], 1.0 / 6);
}

TEST(MeanOf, OneNumberHasNoKnownError) {
    const double one[]{3};
    EXPECT_TRUE(std::isinf(meanOf(one).se));
    const double three[]{1, 2, 3};
    EXPECT_DOUBLE_EQ(meanOf(three).value, 2);
    EXPECT_DOUBLE_EQ(meanOf(three).se, 1 / std::sqrt(3));
}

}  // namespace
}  // namespace woodcock::test
