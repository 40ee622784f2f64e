// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/resample.h"

#include <gtest/gtest.h>

#include "tests/compare/pictures.h"
#include "woodcock/base/statistics.h"

namespace woodcock::test {

using namespace compare;

namespace {

TEST(Shrink, FractionsOfPixelsCountAsSuch) {
    Picture p = picture(3, 1, {"R"}, [](int x, int) {
        return x == 0 ? 6.0 : x == 1 ? 12.0 : 30.0;
    });
    p.planes[0].errors = {0.3f, 0.6f, 0.9f};
    shrink(p, 2, 1);
    EXPECT_EQ(p.width, 2);
    EXPECT_FLOAT_EQ(p.planes[0].values[0], (6 + 0.5f * 12) / 1.5f);
    EXPECT_FLOAT_EQ(p.planes[0].values[1], (0.5f * 12 + 30) / 1.5f);
    EXPECT_FLOAT_EQ(p.planes[0].errors[0], std::sqrt(0.09f + 0.25f * 0.36f) / 1.5f);
}

TEST(Shrink, KeepsTheMean) {
    Picture p = picture(100, 70, {"R"}, [](int x, int y) { return std::sin(x) + 0.1 * y * y; });
    const auto mean = [](const Picture& of) {
        Moments m;
        for (const float v : of.planes[0].values) m.add(v);
        return m.mean();
    };
    const double before = mean(p);
    shrink(p, 33, 41);
    EXPECT_EQ(p.planes[0].values.size(), 33u * 41u);
    EXPECT_NEAR(mean(p), before, 1e-5 * before);
}

// Neighbours that share a pixel share its noise: a mean over many varies more than they tell.
TEST(Shrink, SaysHowMuchNoiseIsShared) {
    std::mt19937_64 random(5);
    Moments means;
    double told = 0;
    constexpr int runs = 2000;
    for (int i = 0; i < runs; ++i) {
        Picture p = noisy(
            picture(24, 24, {"R"}, [](int, int) { return 0.0; }), [](int, int) { return 1.0; },
            true, random);
        shrink(p, 16, 16);
        Moments m;
        double variance = 0;
        for (std::size_t k = 0; k < 256; ++k) {
            m.add(p.planes[0].values[k]);
            variance += std::pow(p.planes[0].errors[k], 2);
        }
        means.add(m.mean());
        told = p.sharedNoise * variance / (256.0 * 256.0);
    }
    EXPECT_NEAR(told, 1 / (24.0 * 24.0), 1e-6);  // that of the mean over all pixels before
    EXPECT_NEAR(means.variance() / told, 1, 4 * std::sqrt(2.0 / runs));
}

}  // namespace
}  // namespace woodcock::test
