// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace medium;

namespace {

const std::vector<double> allG{0,   1e-7, -1e-7, 1e-3,  -1e-3,  0.3,    -0.5,
                               0.5, 0.9,  0.99,  -0.99, 0.9999, -0.9999};

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

}  // namespace
}  // namespace woodcock::test
