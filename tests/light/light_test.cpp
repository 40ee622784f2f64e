// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace light;

namespace {

TEST(Sun, WithoutAWidthIsADelta) {
    const Sun sun({0, -2, 0}, {3, 2, 1}, 0, true);
    EXPECT_TRUE(sun.delta());
    const LightSample s = sun.sample({}, 0.3, 0.7);
    EXPECT_EQ(s.direction, (Vec3d{0, 1, 0}));
    EXPECT_EQ(s.weight, (Rgb{3, 2, 1}));
    EXPECT_EQ(s.pdf, 0);
    EXPECT_EQ(sun.pdf({}, {0, 1, 0}), 0);
    EXPECT_EQ(sun.radiance({0, 1, 0}), Rgb(0.0f));
}

TEST(PointLight, FallsWithTheSquareOfTheDistance) {
    const PointLight light{{1, 2, 3}, {8, 4, 2}};
    const LightSample s = light.sample({1, 2, 1}, 0, 0);
    EXPECT_EQ(s.direction, (Vec3d{0, 0, 1}));
    EXPECT_EQ(s.distance, 2);
    EXPECT_EQ(s.weight, (Rgb{2, 1, 0.5}));
    EXPECT_EQ(s.pdf, 0);
    EXPECT_EQ(light.sample({1, 2, 3}, 0, 0).weight, Rgb(0.0f));
}

TEST(SphereLight, IsHitWhereItsSurfaceIs) {
    const SphereLight light{{0, 0, 10}, 2, Rgb(1.0f)};
    constexpr double miss = std::numeric_limits<double>::infinity();
    EXPECT_DOUBLE_EQ(light.hit({0, 0, 0}, {0, 0, 1}), 8);
    EXPECT_DOUBLE_EQ(light.hit({1, 0, 0}, {0, 0, 1}), 10 - std::sqrt(3.0));
    EXPECT_EQ(light.hit({0, 0, 0}, {0, 0, -1}), miss);
    EXPECT_EQ(light.hit({2.001, 0, 0}, {0, 0, 1}), miss);
    EXPECT_EQ(light.hit({0, 0, 10.5}, {0, 0, 1}), miss);  // from inside
    EXPECT_EQ(light.hit({0, 0, 13}, {0, 0, 1}), miss);    // behind
    RandomStream random(4);
    for (int i = 0; i < 1000; ++i) {
        const LightSample s = light.sample({3, 4, 0}, random.uniform(), random.uniform());
        EXPECT_NEAR(length(Vec3d{3, 4, 0} + s.direction * s.distance - light.position), 2, 1e-6);
    }
}

TEST(SphereLight, GivesNothingInsideItself) {
    const SphereLight light{{0, 0, 0}, 2, Rgb(1.0f)};
    for (Vec3d from : {Vec3d{}, Vec3d{1, 0, 0}, Vec3d{0, -1.9999, 0}, Vec3d{2, 0, 0}}) {
        EXPECT_EQ(light.sample(from, 0.5, 0.5).weight, Rgb(0.0f));
        EXPECT_EQ(light.pdf(from, {1, 0, 0}), 0);
    }
}

}  // namespace
}  // namespace woodcock::test
