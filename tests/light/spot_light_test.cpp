// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/spot_light.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/light/light.h"

namespace woodcock::test {

using namespace light;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SpotLight, ShinesIntoItsConeAlone) {
    const SpotLight light({0, 5, 0}, {0, -2, 0}, {8, 4, 2}, 60, 0);
    const LightSample s = light.sample({0, 3, 0}, 0, 0);
    EXPECT_EQ(s.direction, (Vec3d{0, 1, 0}));
    EXPECT_EQ(s.distance, 2);
    EXPECT_EQ(s.weight, (Rgb{2, 1, 0.5}));
    EXPECT_EQ(s.pdf, 0);
    const double edge = std::tan(30 * pi / 180);
    EXPECT_GT(light.sample({edge - 1e-6, 4, 0}, 0, 0).weight[0], 0);
    EXPECT_EQ(light.sample({edge + 1e-6, 4, 0}, 0, 0).weight, Rgb(0.0f));
    EXPECT_EQ(light.sample({0, 7, 0}, 0, 0).weight, Rgb(0.0f));
    EXPECT_EQ(light.sample({0, 5, 0}, 0, 0).weight, Rgb(0.0f));
}

/// Halfway through the soft edge, in the cosine, smoothstep is one half.
TEST(SpotLight, FallsOffLikeSmoothstep) {
    const SpotLight light({}, {0, 0, 1}, Rgb(1.0f), 90, 0.4);
    const double below = 1 - std::cos(pi / 4);
    EXPECT_NEAR(light.fallOff(below * 0.8), 0.5, 1e-12);
    EXPECT_NEAR(light.fallOff(below * 0.9), 0.25 * 0.25 * 2.5, 1e-12);
    EXPECT_EQ(light.fallOff(below * 0.6 - 1e-9), 1);
    EXPECT_EQ(light.fallOff(below + 1e-9), 0);
}

/// What a ray is narrowed to is the part of it that the light shines on.
TEST(SpotLight, NarrowsRaysToItsCone) {
    RandomStream random(3);
    const auto r = [&] { return 4 * random.uniform() - 2; };
    int wholly = 0, partly = 0, never = 0;
    for (int i = 0; i < 20000; ++i) {
        const double cone = i % 4 == 0 ? 180 : 180 * random.uniform();
        const SpotLight light({r(), r(), r()}, normalize(Vec3d{r(), r(), r()}), Rgb(1.0f), cone, 0);
        const Vec3d origin{r(), r(), r()}, direction = normalize(Vec3d{r(), r(), r()});
        const double far = i % 3 == 0 ? infinity : 3;
        double t0 = 0, t1 = far;
        light.narrow(origin, direction, t0, t1);
        ASSERT_TRUE(t0 >= 0 && t0 <= t1 && t1 <= far);
        wholly += t0 == 0 && t1 == far, never += t0 == t1, partly += t0 > 0 && t0 < t1;
        for (int k = 0; k < 20; ++k) {
            const double t = 3 * random.uniform();
            if (std::abs(t - t0) < 1e-9 || std::abs(t - t1) < 1e-9) continue;
            const bool lit = light.sample(origin + direction * t, 0, 0).weight[0] > 0;
            ASSERT_EQ(lit, t > t0 && t < t1) << i << " " << t << " " << t0 << " " << t1;
        }
    }
    EXPECT_GT(std::min({wholly, partly, never}), 500);
}

TEST(Light, AnswersForItsKind) {
    const Light spot = SpotLight({1, 2, 3}, {0, -1, 0}, {5, 6, 7}, 30, 0.1);
    EXPECT_EQ(spot.traits().position, (Vec3d{1, 2, 3}));
    EXPECT_EQ(spot.traits().intensity, 7);
    EXPECT_FALSE(spot.meetsRays());
    EXPECT_EQ(spot.meet({1, 5, 3}, {0, -1, 0}).distance, infinity);
    EXPECT_EQ(spot.distantRadiance({0, 1, 0}), Rgb(0.0f));
    EXPECT_EQ(spot.importance({{1, 3, 3}, {0, 0, 1}}), 0);
    EXPECT_NEAR(spot.importance({{1, 0, 3}, {0, 0, 1}}), 6 / 4.0 / (4 * pi), 1e-6);
    EXPECT_EQ(spot.flaw(), "");
    const Light sun = Sun({0, -1, 0}, Rgb(1.0f), 1e-30, false);
    EXPECT_NE(sun.flaw().find("so narrow"), std::string::npos);
    EXPECT_TRUE(sun.traits().distant);
}

}  // namespace
}  // namespace woodcock::test
