// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "woodcock/base/random.h"
#include "woodcock/base/statistics.h"
#include "woodcock/base/vec.h"

namespace woodcock::test {

using namespace trade;

namespace {

/// By Box and Muller.
double normal(RandomStream& random) {
    return std::sqrt(-2 * std::log(random.uniformOpenLow())) * std::cos(2 * pi * random.uniform());
}

/// y = 3 x^1.5 with normal errors of this relative size, which the points are told of, or not.
std::vector<CurvePoint> powerLaw(double error, double told, std::uint64_t seed) {
    RandomStream random(seed);
    std::vector<CurvePoint> points;
    for (const double x : {0.1, 0.5, 1.0, 4.0, 10.0, 70.0, 1000.0}) {
        const double y = 3 * std::pow(x, 1.5) * std::exp(error * normal(random));
        points.push_back({x, y, told * y});
    }
    return points;
}

TEST(FitSlope, PowersAreFoundExactly) {
    const Measured slope = fitSlope(powerLaw(0, 0, 1));
    EXPECT_NEAR(slope.value, 1.5, 1e-12);
    EXPECT_NEAR(slope.se, 0, 1e-12);
    EXPECT_NEAR(fitSlope({{1, 5, 0}, {2, 5, 0}, {8, 5, 0}}).value, 0, 1e-12);
}

TEST(FitSlope, TheErrorIsThatOfTheSlope) {
    // Told or not, in 68 % of 400 data sets the slope lies within a standard error. The error by
    // scatter is itself known from 5 degrees of freedom: Student's t says 63 %. The larger of both
    // errors is taken, so with told errors it is more: at most all.
    int within = 0;
    Moments slopes, told;
    for (std::uint64_t i = 0; i < 400; ++i) {
        const Measured slope = fitSlope(powerLaw(0.1, 0, i));
        within += std::abs(slope.value - 1.5) < slope.se;
        slopes.add(slope.value);
        told.add(fitSlope(powerLaw(0.1, 0.1, i)).se);
    }
    const double expected = 0.637;
    EXPECT_NEAR(within / 400.0, expected, 4 * std::sqrt(expected * (1 - expected) / 400));
    EXPECT_NEAR(slopes.mean(), 1.5, 4 * slopes.standardError());
    // sigma / sqrt(sum (log x - mean)^2), which the scatter can only add to.
    const double truth = std::sqrt(slopes.variance());
    EXPECT_GT(told.mean(), truth * 0.9);
    EXPECT_LT(told.mean(), truth * 1.3);
}

TEST(FitSlope, OfTwoPointsOnlyTheirOwnErrorsSpeak) {
    const Measured slope = fitSlope({{1, 1, 0.01}, {std::exp(1.0), 1, 0.01}});
    EXPECT_NEAR(slope.value, 0, 1e-12);
    EXPECT_NEAR(slope.se, 0.01 * std::sqrt(2.0), 1e-12);
}

TEST(FitSlope, WithoutTwoPlacesThereIsNone) {
    for (const auto& points : std::vector<std::vector<CurvePoint>>{
             {}, {{1, 1, 0}}, {{2, 1, 0}, {2, 3, 0}}, {{0, 1, 0}, {3, 2, 0}, {5, -1, 0}}}) {
        const Measured slope = fitSlope(points);
        EXPECT_EQ(slope.value, 0);
        EXPECT_EQ(slope.se, std::numeric_limits<double>::infinity());
    }
}

TEST(MedianOf, IsNotMovedByARunThatWasDisturbed) {
    const Measured m = medianOf({1, 1.01, 0.99, 1.02, 50, 0.98, 1});
    EXPECT_EQ(m.value, 1);
    EXPECT_LT(m.se, 0.02);
    EXPECT_EQ(medianOf({4, 2}).value, 3);
    EXPECT_EQ(medianOf({}).value, 0);
    EXPECT_EQ(medianOf({7}).se, std::numeric_limits<double>::infinity());
}

TEST(MedianOf, TheErrorIsThatOfTheMedian) {
    RandomStream random(5);
    Moments medians, errors;
    for (int set = 0; set < 2000; ++set) {
        std::vector<double> values;
        for (int i = 0; i < 15; ++i) values.push_back(normal(random));
        const Measured m = medianOf(values);
        medians.add(m.value), errors.add(m.se);
    }
    EXPECT_NEAR(medians.mean(), 0, 4 * medians.standardError());
    EXPECT_NEAR(errors.mean() / std::sqrt(medians.variance()), 1, 0.1);
}

}  // namespace
}  // namespace woodcock::test
