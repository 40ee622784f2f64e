// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase.h"
#include "tests/support/expect_mean.h"

#include <gtest/gtest.h>

#include "tests/support/statistics.h"
#include "woodcock/base/random.h"

namespace woodcock::test {
namespace {

const std::vector<double> allG{0,   1e-7, -1e-7, 1e-3,  -1e-3,  0.3,    -0.5,
                               0.5, 0.9,  0.99,  -0.99, 0.9999, -0.9999};

/// 2 pi times the integral of f(cosine) x phase over cosines, in the variable that spreads the peak
/// out: y = log of the distance from it.
template <class F>
double overSphere(double g, F&& f) {
    const double peak = g >= 0 ? 1 : -1, width = 1e-3 * (1 - std::abs(g)) * (1 - std::abs(g));
    return 2 * pi * integrate(std::log(width), std::log(2 + width), 400, [&](double y) {
               const double distance = std::exp(y) - width, cosine = peak * (1 - distance);
               return henyeyGreenstein(cosine, g) * f(cosine) * std::exp(y);
           });
}

TEST(Phase, IntegratesToOneWithMeanCosineG) {
    for (double g : allG) {
        // Near +-1 the cosine itself is known to 1e-16 only, beside a peak 1e-8 wide.
        const double tolerance = std::abs(g) > 0.999 ? 1e-7 : 1e-10;
        EXPECT_NEAR(overSphere(g, [](double) { return 1.0; }), 1, tolerance) << g;
        EXPECT_NEAR(overSphere(g, [](double c) { return c; }), g, tolerance) << g;
    }
}

TEST(Phase, IsotropicIsExactlyIsotropic) {
    for (double cosine : {-1.0, -0.3, 0.0, 0.7, 1.0})
        EXPECT_EQ(henyeyGreenstein(cosine, 0), 1 / (4 * pi));
}

TEST(Phase, BackwardIsForwardReversed) {
    for (double g : allG)
        for (double cosine : {-1.0, -0.99, 0.1, 0.5, 1.0})
            EXPECT_EQ(henyeyGreenstein(cosine, g), henyeyGreenstein(-cosine, -g));
}

TEST(Phase, SampledDirectionsAreUnitAndCarryTheirDensity) {
    RandomStream random(1);
    for (double g : allG)
        for (int i = 0; i < 2000; ++i) {
            const auto r = [&] { return 2 * random.uniform() - 1; };
            const Vec3d forward = normalize(Vec3d{r(), r(), r()});
            // All of [0, 1), its ends included.
            const double u0 = i == 0 ? 0 : i == 1 ? 1 - 0x1p-53 : random.uniform();
            const PhaseSample s = sampleHenyeyGreenstein(forward, g, u0, random.uniform());
            EXPECT_NEAR(length(s.direction), 1, 1e-15);
            ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf > 0);
            const double rounding = 1e-15 / ((1 - std::abs(g)) * (1 - std::abs(g)));
            EXPECT_NEAR(henyeyGreenstein(dot(forward, s.direction), g) / s.pdf, 1,
                        1e-12 + 3 * rounding);
        }
}

TEST(Phase, SamplesAreDistributedAsTheDensitySays) {
    constexpr int n = 100000, rings = 20, sectors = 8;
    const Vec3d forward = normalize(Vec3d{0.3, -0.5, -0.7});
    Vec3d x, y;
    orthonormalBasis(forward, x, y);
    for (double g : allG) {
        // Rings between cosines whose closed-form share is even: F(c) of Henyey-Greenstein.
        const auto below = [&](double distance) {  // share of 1 - peak x cosine < distance
            const double a = std::abs(g);
            if (a < 1e-5) return distance / 2 + a * (distance / 2) * (2 - distance) * 1.5;
            const double d = std::sqrt((1 - a) * (1 - a) + 2 * a * distance);
            return (1 + a) / (2 * a) * (1 - (1 - a) / d);
        };
        RandomStream random(2);
        std::vector<double> counts(rings * sectors),
            expected(rings * sectors, n / double(rings * sectors));
        Moments cosine;
        for (int i = 0; i < n; ++i) {
            const Vec3d d =
                sampleHenyeyGreenstein(forward, g, random.uniform(), random.uniform()).direction;
            const Vec3d peak = g >= 0 ? forward : -forward;
            const double share = below(dot(d - peak, d - peak) / 2);
            const double angle = std::atan2(dot(d, y), dot(d, x)) / (2 * pi) + 0.5;
            const int ring = std::clamp(static_cast<int>(share * rings), 0, rings - 1);
            const int sector = std::clamp(static_cast<int>(angle * sectors), 0, sectors - 1);
            ++counts[static_cast<std::size_t>(ring * sectors + sector)];
            cosine.add(dot(d, forward));
        }
        EXPECT_GT(chiSquareProbability(counts, expected), leastProbability) << g;
        expectMean(cosine, g, 0.002, "mean cosine");
    }
}

}  // namespace
}  // namespace woodcock::test
