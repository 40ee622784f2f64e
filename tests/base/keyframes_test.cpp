// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/keyframes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"

namespace woodcock::test {

namespace {

std::vector<std::vector<double>> column(const std::vector<double>& numbers) {
    std::vector<std::vector<double>> values;
    for (const double v : numbers) values.push_back({v});
    return values;
}

}  // namespace

TEST(Keyframes, LinearAndConstantHoldBeforeAndAfter) {
    const std::vector<double> frames{-1, 3, 4};
    const Keyframes linear(frames, {{2, 0}, {6, 8}, {6, 4}}, Interpolation::Linear);
    EXPECT_EQ(linear.at(-7), (std::vector<double>{2, 0}));
    EXPECT_EQ(linear.at(0), (std::vector<double>{3, 2}));
    EXPECT_EQ(linear.at(3), (std::vector<double>{6, 8}));
    EXPECT_EQ(linear.at(3.25), (std::vector<double>{6, 7}));
    EXPECT_EQ(linear.at(1e6), (std::vector<double>{6, 4}));
    const Keyframes constant(frames, column({2, 6, 9}), Interpolation::Constant);
    EXPECT_EQ(constant.at(-7)[0], 2);
    EXPECT_EQ(constant.at(std::nextafter(3.0, 0.0))[0], 2);
    EXPECT_EQ(constant.at(3)[0], 6);
    EXPECT_EQ(constant.at(4)[0], 9);
    EXPECT_EQ(constant.at(5)[0], 9);
}

TEST(Keyframes, SmoothStaysBetweenTheValuesOfItsKeys) {
    RandomStream random(1);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> x{random.uniform()}, y;
        for (int i = 0; i < 6; ++i) {
            x.push_back(x.back() + std::pow(10, 4 * random.uniform() - 2));
            y.push_back(std::pow(10, 6 * random.uniform() - 3) * (random.uniform() - 0.5));
        }
        y.push_back(y.back());
        const Keyframes smooth(x, column(y), Interpolation::Smooth);
        for (std::size_t i = 0; i + 1 < x.size(); ++i) {
            double before = y[i];
            for (int k = 0; k <= 50; ++k) {
                const double v = smooth.at(x[i] + (x[i + 1] - x[i]) * k / 50)[0];
                // Monotone: it never turns back.
                const double size = std::max(std::abs(y[i]), std::abs(y[i + 1]));
                EXPECT_GE((v - before) * (y[i + 1] - y[i] >= 0 ? 1 : -1), -1e-12 * size);
                before = v;
            }
        }
    }
}

TEST(Keyframes, SmoothHasAContinuousSlopeAndKeepsStraightLines) {
    // The data of Fritsch and Carlson 1980, sec. 1.
    const std::vector<double> x{7.99, 8.09, 8.19, 8.7, 9.2, 10, 12, 15, 20};
    const std::vector<double> y{0,       2.76429e-5, 4.37498e-2, 0.169183, 0.469428,
                                0.94374, 0.998636,   0.999919,   0.999994};
    const Keyframes smooth(x, column(y), Interpolation::Smooth);
    constexpr double h = 1e-6;
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
        const double left = (y[i] - smooth.at(x[i] - h)[0]) / h;
        const double right = (smooth.at(x[i] + h)[0] - y[i]) / h;
        EXPECT_NEAR(left, right, 1e-4) << x[i];
    }
    const Keyframes line({0, 1, 4, 5}, column({1, 3, 9, 11}), Interpolation::Smooth);
    for (double f = 0; f <= 5; f += 0.125) EXPECT_NEAR(line.at(f)[0], 1 + 2 * f, 1e-14);
    // Level where it turns, and beside a pause.
    const Keyframes turns({0, 1, 2, 3}, column({0, 1, 0, 0}), Interpolation::Smooth);
    EXPECT_NEAR(turns.at(1 + h)[0], 1, 10 * h * h);
    EXPECT_NEAR(turns.at(2 - h)[0], 0, 10 * h * h);
}

}  // namespace woodcock::test
