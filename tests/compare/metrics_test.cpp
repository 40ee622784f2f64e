// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace woodcock::test {

using namespace compare;

namespace {

TEST(DifferenceMetrics, ByHand) {
    const std::vector<float> a{1, 2, 0, -4}, b{1, 3, 0.5f, -6};
    const DifferenceMetrics m = differenceMetrics(a, b, 2);
    EXPECT_EQ(m.pixels, 4u);
    EXPECT_DOUBLE_EQ(m.meanA, -0.25);
    EXPECT_DOUBLE_EQ(m.meanB, -0.375);
    EXPECT_DOUBLE_EQ(m.rmse, std::sqrt((1 + 0.25 + 4) / 4));
    EXPECT_DOUBLE_EQ(m.relMse, (1 / 4.01 + 0.25 / 0.01 + 4 / 16.01) / 4);
    EXPECT_EQ(m.peak, 4);
    EXPECT_DOUBLE_EQ(m.psnr, 10 * std::log10(16 / (5.25 / 4)));
    ASSERT_EQ(m.largest.size(), 3u);  // a pixel that is equal is no difference
    EXPECT_EQ(m.largest[0].x, 1);
    EXPECT_EQ(m.largest[0].y, 1);
    EXPECT_EQ(m.largest[0].a, -4);
    EXPECT_EQ(m.largest[0].b, -6);
    EXPECT_EQ(m.largest[1].x, 1);
    EXPECT_EQ(m.largest[1].y, 0);
    EXPECT_EQ(m.largest[2].x, 0);
    EXPECT_EQ(m.largest[2].y, 1);
}

TEST(DifferenceMetrics, KeepsTheFiveLargest) {
    std::vector<float> a(100, 1), b(100, 1);
    for (const int i : {3, 50, 51, 52, 53, 99}) b[static_cast<std::size_t>(i)] = 2;
    b[70] = 5;
    const DifferenceMetrics m = differenceMetrics(a, b, 10);
    ASSERT_EQ(m.largest.size(), 5u);
    EXPECT_EQ(m.largest[0].y * 10 + m.largest[0].x, 70);
    EXPECT_EQ(m.largest[1].y * 10 + m.largest[1].x, 3);
    EXPECT_EQ(m.largest[4].y * 10 + m.largest[4].x, 52);
}

TEST(DifferenceMetrics, EqualChannels) {
    const std::vector<float> a{1, 2};
    const DifferenceMetrics m = differenceMetrics(a, a, 2);
    EXPECT_EQ(m.rmse, 0);
    EXPECT_EQ(m.psnr, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(m.largest.empty());
}

TEST(DifferenceMetrics, NonFiniteOnEitherSide) {
    const float nan = std::nanf(""), infinite = std::numeric_limits<float>::infinity();
    const DifferenceMetrics m = differenceMetrics(std::vector{1.0f, nan, 2.0f, infinite},
                                                  std::vector{1.0f, 2.0f, nan, nan}, 4);
    EXPECT_EQ(m.pixels, 1u);
    EXPECT_EQ(m.nonFiniteA, 2u);
    EXPECT_EQ(m.nonFiniteB, 2u);
    EXPECT_EQ(m.nonFiniteInOne, 2u);
    EXPECT_EQ(m.rmse, 0);
}

}  // namespace
}  // namespace woodcock::test
