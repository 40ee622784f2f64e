// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/statistics.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::test {

using namespace proof;

namespace {

TEST(Statistics, MomentsOfAFewNumbers) {
    Moments m;
    EXPECT_EQ(m.mean(), 0);
    EXPECT_EQ(m.standardError(), 0);
    m.add(2);
    EXPECT_EQ(m.variance(), 0);
    m.add(4), m.add(9);
    EXPECT_EQ(m.count(), 3u);
    EXPECT_DOUBLE_EQ(m.mean(), 5);
    EXPECT_DOUBLE_EQ(m.variance(), 13);  // (9 + 1 + 16) / 2
    EXPECT_DOUBLE_EQ(m.standardError(), std::sqrt(13.0 / 3));
}

TEST(Statistics, ALargeOffsetCostsNoDigitsOfTheVariance) {
    Moments m;
    for (int i = 0; i < 1000; ++i) m.add(1e9 + (i & 1));
    EXPECT_NEAR(m.variance(), 0.25 * 1000 / 999, 1e-9);
}

TEST(Statistics, ChiSquareMatchesTheTables) {  // upper 5 % and 0.1 % points of the distribution
    const auto probability = [](double statistic, std::size_t freedom) {
        std::vector<double> expected(freedom + 1, 1000), counts = expected;
        counts[0] += std::sqrt(statistic * 1000 / 2), counts[1] -= std::sqrt(statistic * 1000 / 2);
        return chiSquareProbability(counts, expected);
    };
    EXPECT_NEAR(probability(3.841, 1), 0.05, 1e-4);
    EXPECT_NEAR(probability(18.307, 10), 0.05, 1e-5);
    EXPECT_NEAR(probability(29.588, 10), 0.001, 1e-6);
    EXPECT_NEAR(probability(149.449, 100), 0.001, 1e-6);
    EXPECT_NEAR(probability(77.929, 100), 0.95, 1e-5);
    EXPECT_EQ(chiSquareProbability({50, 50, 1}, {50, 51, 0}), 0);
}

TEST(Statistics, GaussLegendreIsExactForPolynomials) {
    for (const std::size_t n : {1, 2, 3, 5, 16, 64})
        for (std::size_t power = 0; power < 2 * n; ++power)
            EXPECT_NEAR(
                integrate(0, 1, n,
                          [&](double x) { return std::pow(x, static_cast<double>(power)); }),
                1 / static_cast<double>(power + 1), 1e-14);
}

}  // namespace
}  // namespace woodcock::test
