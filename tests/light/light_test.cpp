// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light.h"
#include "tests/support/expect_mean.h"

#include <gtest/gtest.h>

#include "tests/light/sky.h"
#include "tests/support/statistics.h"
#include "woodcock/base/random.h"

namespace woodcock::test {
namespace {

const Vec3d axis = normalize(Vec3d{0.3, 0.8, -0.4});

/// Directions drawn by `sample` must be even over the cone of 1 - cos = `cone` around the axis, and
/// carry its density, which `pdf` must give inside the cone and not outside.
template <class Sample, class Pdf>
void expectEvenCone(double cone, Sample&& sample, Pdf&& pdf) {
    constexpr int n = 20000, rings = 10, sectors = 10;
    const double density = 1 / (2 * pi * cone);
    RandomStream random(1);
    std::vector<double> counts(rings * sectors),
        expected(rings * sectors, n / double(rings * sectors));
    for (int i = 0; i < n; ++i) {
        const LightSample s = sample(random.uniform(), random.uniform());
        ASSERT_NEAR(length(s.direction), 1, 1e-14);
        ASSERT_NEAR(s.pdf / density, 1, 1e-9);
        const double share = below(s.direction, axis) / cone;
        ASSERT_LE(share, 1 + 1e-6);
        const int ring = std::min(static_cast<int>(share * rings), rings - 1);
        const int sector =
            std::min(static_cast<int>(turn(axis, s.direction) * sectors), sectors - 1);
        ++counts[static_cast<std::size_t>(ring * sectors + sector)];
    }
    EXPECT_GT(chiSquareProbability(counts, expected), leastProbability);
    for (double angle : {0.0, 1.0, 3.0, 5.0}) {
        for (double share : {0.0, 0.1, 0.5, 0.99, 0.9999})
            EXPECT_NEAR(pdf(around(axis, share * cone, angle)) / density, 1, 1e-9);
        for (double share : {1.0001, 1.1, 2.0, 10.0})
            if (share * cone < 2) {
                EXPECT_EQ(pdf(around(axis, share * cone, angle)), 0);
            }
    }
}

TEST(Sun, DiscIsSampledEvenlyAndGivesTheIrradianceAskedFor) {
    for (double degrees : {1e-4, 0.5, 10.0, 90.0, 180.0}) {
        const Rgb irradiance{3, 2, 1};
        const Sun sun(-axis * 7.0, irradiance, degrees, true);
        EXPECT_FALSE(sun.delta());
        const double half = degrees * pi / 360, cone = 2 * std::pow(std::sin(half / 2), 2);
        expectEvenCone(
            cone, [&](double u, double v) { return sun.sample(u, v); },
            [&](Vec3d d) { return sun.pdf(d); });
        for (int c = 0; c < 3; ++c) {  // on a plane that faces it: radiance x cosine over the disc
            const double found = 2 * pi * integrate(0, cone, 64, [&](double b) {
                                     return (1 - b) * sun.radiance(around(axis, b, 1))[c];
                                 });
            EXPECT_NEAR(found / irradiance[c], 1, 1e-6) << degrees;
        }
        Moments byWeight;
        RandomStream random(2);
        for (int i = 0; i < 20000; ++i) {
            const LightSample s = sun.sample(random.uniform(), random.uniform());
            byWeight.add(s.weight[0] * dot(s.direction, axis));
            EXPECT_EQ(s.distance, std::numeric_limits<double>::infinity());
        }
        expectMean(byWeight, 3, 0.02, "irradiance by samples");
    }
}

TEST(Sun, WithoutAWidthIsADelta) {
    const Sun sun({0, -2, 0}, {3, 2, 1}, 0, true);
    EXPECT_TRUE(sun.delta());
    const LightSample s = sun.sample(0.3, 0.7);
    EXPECT_EQ(s.direction, (Vec3d{0, 1, 0}));
    EXPECT_EQ(s.weight, (Rgb{3, 2, 1}));
    EXPECT_EQ(s.pdf, 0);
    EXPECT_EQ(sun.pdf({0, 1, 0}), 0);
    EXPECT_EQ(sun.radiance({0, 1, 0}), Rgb(0.0f));
}

TEST(PointLight, FallsWithTheSquareOfTheDistance) {
    const PointLight light{{1, 2, 3}, {8, 4, 2}};
    const LightSample s = light.sample({1, 2, 1});
    EXPECT_EQ(s.direction, (Vec3d{0, 0, 1}));
    EXPECT_EQ(s.distance, 2);
    EXPECT_EQ(s.weight, (Rgb{2, 1, 0.5}));
    EXPECT_EQ(s.pdf, 0);
    EXPECT_EQ(light.sample({1, 2, 3}).weight, Rgb(0.0f));
}

TEST(SphereLight, IsSampledEvenlyFromFarNearAndJustOutside) {
    for (double distance : {1.0001, 1.5, 10.0, 1e4, 1e7}) {
        const double radius = 2.5, sine = 1 / distance;
        const Vec3d from{5, -3, 2};
        const SphereLight light{from + axis * (radius * distance), radius, Rgb(1.0f)};
        const double cone = sine * sine / (1 + std::sqrt(1 - sine * sine));
        expectEvenCone(
            cone, [&](double u, double v) { return light.sample(from, u, v); },
            [&](Vec3d d) { return light.pdf(from, d); });
    }
}

TEST(SphereLight, IrradianceIsTheClosedForm) {  // pi L (r / d)^2 on a plane that faces it
    for (double distance : {1.01, 1.5, 10.0, 1e6}) {
        const SphereLight light{axis * distance, 1, Rgb(2.0f)};
        Moments irradiance;
        RandomStream random(3);
        for (int i = 0; i < 50000; ++i) {
            const LightSample s = light.sample({}, random.uniform(), random.uniform());
            irradiance.add(s.weight[0] * dot(s.direction, axis) * distance * distance);
            EXPECT_GE(s.distance, (distance - 1) * (1 - 1e-9));
            EXPECT_LE(s.distance, distance);
        }
        expectMean(irradiance, 2 * pi, 0.03, "irradiance");
    }
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
