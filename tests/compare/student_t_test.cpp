// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/student_t.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace woodcock::test {

using namespace compare;

namespace {

void expectRelative(double value, double expected, double error = 1e-10) {
    EXPECT_NEAR(value / expected, 1, error) << value << " of " << expected;
}

TEST(StudentT, ClosedForms) {
    for (const double t : {1e-3, 0.3, 1.0, 4.0, 50.0, 1e4, 1e8}) {
        expectRelative(studentTwoSided(t, 1), 2 / std::numbers::pi * std::atan(1 / t));
        // 1 - t / sqrt(2 + t^2), without its cancellation
        const double root = std::sqrt(2 + t * t);
        expectRelative(studentTwoSided(t, 2), 2 / (root * (root + t)));
        EXPECT_EQ(studentTwoSided(-t, 2), studentTwoSided(t, 2));
    }
}

// Critical values of printed tables, which have five digits.
TEST(StudentT, PublishedTable) {
    EXPECT_NEAR(studentTwoSided(2.7764, 4), 0.05, 1e-5);
    EXPECT_NEAR(studentTwoSided(3.1693, 10), 0.01, 1e-5);
    EXPECT_NEAR(studentTwoSided(3.6460, 30), 0.001, 1e-6);
    EXPECT_NEAR(studentTwoSided(1.9799, 120), 0.05, 1e-5);
}

TEST(StudentT, ManyDegreesBecomeNormal) {
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double t : {0.1, 1.0, 4.0, 9.0}) {
        const double normal = std::erfc(t / std::numbers::sqrt2);
        EXPECT_DOUBLE_EQ(studentTwoSided(t, infinite), normal);
        // To first order in 1 / degrees, the logarithm of the tail falls short by t^4 / (4
        // degrees).
        EXPECT_NEAR(studentTwoSided(t, 1e9) / normal, 1, 1e-8 + t * t * t * t * 1e-9);
    }
}

TEST(StudentT, Ends) {
    EXPECT_EQ(studentTwoSided(0, 7), 1);
    EXPECT_EQ(studentTwoSided(std::numeric_limits<double>::infinity(), 7), 0);
    EXPECT_TRUE(std::isnan(studentTwoSided(std::nan(""), 7)));
    EXPECT_GT(studentTwoSided(40, 63), 0);
}

}  // namespace
}  // namespace woodcock::test
