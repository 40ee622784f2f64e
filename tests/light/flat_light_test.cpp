// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/flat_light.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/light/disk_light.h"
#include "woodcock/light/rectangle_light.h"
#include "woodcock/light/spherical_triangle.h"

namespace woodcock::test {

using namespace light;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// In z = 0, 4 wide and 2 high, facing +z.
FlatLight facingUp() {
    return {.centre = {},
            .x = {1, 0, 0},
            .y = {0, 1, 0},
            .normal = {0, 0, 1},
            .halfX = 2,
            .halfY = 1,
            .radiance = Rgb(3.0f)};
}

/// The solid angle of two triangles, which a file of its own finds.
TEST(SeenRectangle, HasTheSolidAngleOfTwoTriangles) {
    RandomStream random(1);
    for (int i = 0; i < 5000; ++i) {
        const auto r = [&] { return 6 * random.uniform() - 3; };
        const double x0 = r(), y0 = r(), x1 = x0 + 3 * random.uniform(),
                     y1 = y0 + 3 * random.uniform(), h = std::pow(10, -4 * random.uniform());
        const std::array<Vec3d, 4> c{Vec3d{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
        const Vec3d from{0, 0, h};
        const double exact = SphericalTriangle({c[0], c[1], c[2]}, from).solidAngle() +
                             SphericalTriangle({c[0], c[2], c[3]}, from).solidAngle();
        ASSERT_NEAR(SeenRectangle(x0, x1, y0, y1, h).solidAngle(), exact, 1e-13 + 1e-9 * exact);
    }
}

/// Half of the samples lie before the x that halves the solid angle, and so on in both numbers.
TEST(SeenRectangle, IsSampledEvenlyInSolidAngle) {
    RandomStream random(2);
    for (int i = 0; i < 500; ++i) {
        const auto r = [&] { return 6 * random.uniform() - 3; };
        const double x0 = r(), y0 = r(), x1 = x0 + 3 * random.uniform(),
                     y1 = y0 + 3 * random.uniform(), h = std::pow(10, -2 * random.uniform());
        const SeenRectangle all(x0, x1, y0, y1, h);
        if (all.solidAngle() < 1e-4) continue;
        const double u0 = random.uniform(), u1 = random.uniform();
        const auto [x, y] = all.sample(u0, u1);
        EXPECT_NEAR(SeenRectangle(x0, x, y0, y1, h).solidAngle() / all.solidAngle(), u0, 1e-7);
        // Of a thin strip along y, u1 lies below the sample.
        const double thin = 1e-4 * (x1 - x0);
        EXPECT_NEAR(SeenRectangle(x - thin, x + thin, y0, y, h).solidAngle() /
                        SeenRectangle(x - thin, x + thin, y0, y1, h).solidAngle(),
                    u1, 1e-4);
    }
}

TEST(Spread, NarrowsAndKeepsThePower) {
    EXPECT_EQ(Spread(180).factor(0.01), 1);
    EXPECT_EQ(Spread(180).largest(), 1);
    const Spread s(90);  // tan 45 degrees = 1
    EXPECT_NEAR(s.largest(), 1 / (1 - pi / 4), 1e-12);
    EXPECT_NEAR(s.factor(1), s.largest(), 1e-12);
    EXPECT_NEAR(s.factor(std::cos(std::atan(0.25))), 0.75 * s.largest(), 1e-12);
    EXPECT_EQ(s.factor(std::cos(46 * pi / 180)), 0);
    EXPECT_EQ(s.factor(-0.9), 0);
    // The series and the difference meet.
    EXPECT_NEAR(Spread(3.437).largest() / Spread(3.438).largest(), std::pow(3.438 / 3.437, 2),
                1e-6);
    EXPECT_TRUE(std::isfinite(Spread(1e-6).largest()));
}

TEST(RectangleLight, IsMetWhereItIsFromTheSideThatShines) {
    RectangleLight light{facingUp()};
    EXPECT_EQ(light.meet({1.9, 0.9, 5}, {0, 0, -1}).distance, 5);
    EXPECT_EQ(light.meet({1.9, 0.9, 5}, {0, 0, -1}).radiance, Rgb(3.0f));
    EXPECT_EQ(light.meet({2.1, 0.9, 5}, {0, 0, -1}).distance, infinity);
    EXPECT_EQ(light.meet({1.9, -1.1, 5}, {0, 0, -1}).distance, infinity);
    EXPECT_EQ(light.meet({0, 0, 5}, {0, 0, 1}).distance, infinity);
    EXPECT_EQ(light.meet({0, 0, -5}, {0, 0, 1}).distance, infinity);  // its back
    EXPECT_EQ(light.meet({0, 0, 0}, {0, 0, 1}).distance, infinity);   // in its plane
    EXPECT_EQ(light.pdf({0, 0, -5}, {0, 0, 1}), 0);
    EXPECT_EQ(light.sample({0, 0, -5}, 0.5, 0.5).weight, Rgb(0.0f));
    EXPECT_EQ(light.sample({0.5, 0, 0}, 0.5, 0.5).weight, Rgb(0.0f));
    light.flat.twoSided = true;
    EXPECT_EQ(light.meet({0, 0, -5}, {0, 0, 1}).distance, 5);
    EXPECT_NEAR(light.sample({0, 0, -5}, 0.5, 0.5).direction.z, 1, 1e-12);
    EXPECT_GT(light.pdf({0, 0, -5}, {0, 0, 1}), 0);
}

TEST(DiskLight, IsRound) {
    FlatLight flat = facingUp();
    const DiskLight ellipse{flat};
    EXPECT_EQ(ellipse.meet({1.9, 0.1, 5}, {0, 0, -1}).distance, 5);
    EXPECT_EQ(ellipse.meet({1.9, 0.9, 5}, {0, 0, -1}).distance, infinity);
    EXPECT_NEAR(ellipse.area(), 2 * pi, 1e-12);
    RandomStream random(5);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d from{6 * random.uniform() - 3, 4 * random.uniform() - 2, random.uniform()};
        const double u = random.uniform();
        const LightSample s = ellipse.sample(from, u, random.uniform());
        if (!(s.pdf > 0)) continue;
        const Vec3d p = from + s.direction * s.distance;
        EXPECT_LE(p.x * p.x / 4 + p.y * p.y, 1 + 1e-9);
        EXPECT_NEAR(p.z, 0, 1e-9);
    }
}

TEST(FlatLight, IsPlacedLikeTheShapes) {
    const Affine3d map =
        Affine3d::translate({1, 2, 3}) * Affine3d::rotate(0, 90) * Affine3d::scale({2, 5, 3});
    const FlatLight f = FlatLight::placed(map, 1, 4);
    EXPECT_EQ(f.centre, (Vec3d{1, 2, 3}));
    EXPECT_NEAR(length(f.normal - Vec3d{0, 0, 1}), 0, 1e-12);
    EXPECT_NEAR(f.halfX, 1, 1e-12);
    EXPECT_NEAR(f.halfY, 6, 1e-12);
}

/// Beyond every lit place the importance is 0, and it is no less where light arrives.
TEST(FlatLight, ImportanceNeglectsNothing) {
    RandomStream random(6);
    const medium::PhaseFunction narrow = medium::HenyeyGreenstein(0.9);
    for (const double spread : {180.0, 60.0, 5.0})
        for (const bool twoSided : {false, true}) {
            FlatLight flat = facingUp();
            flat.spread = Spread(spread), flat.twoSided = twoSided;
            const RectangleLight rectangle{flat};
            const DiskLight disk{flat};
            for (int i = 0; i < 3000; ++i) {
                const auto r = [&] { return 8 * random.uniform() - 4; };
                const Vec3d from{r(), r(), r() * std::pow(0.1, i % 5)};
                const ScatterPoint at{from, normalize(Vec3d{r(), r(), r()}), &narrow};
                const double u = random.uniform(), v = random.uniform();
                const bool litByRectangle = rectangle.sample(from, u, v).weight[0] > 0;
                const bool litByDisk = disk.sample(from, u, v).weight[0] > 0;
                EXPECT_GE(rectangle.importance(at) > 0, litByRectangle);
                EXPECT_GE(disk.importance(at) > 0, litByDisk);
                EXPECT_TRUE(twoSided || from.z > 0 || rectangle.importance(at) == 0);
            }
        }
}

TEST(FlatLight, NarrowsRaysToItsSide) {
    const RectangleLight light{facingUp()};
    double t0 = 0, t1 = infinity;
    light.narrow({0, 0, -2}, {0, 0, 1}, t0, t1);
    EXPECT_EQ(t0, 2);
    EXPECT_EQ(t1, infinity);
    t0 = 0, t1 = 1;
    light.narrow({0, 0, -2}, {0, 0, 1}, t0, t1);
    EXPECT_EQ(t0, t1);
    t0 = 0, t1 = infinity;
    light.narrow({0, 0, 3}, {0, 0, -1}, t0, t1);
    EXPECT_EQ(t1, 3);
    t0 = 0, t1 = infinity;
    light.narrow({0, 0, -3}, {1, 0, 0}, t0, t1);
    EXPECT_EQ(t0, t1);
}

}  // namespace
}  // namespace woodcock::test
