// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/vec.h"

#include <gtest/gtest.h>

#include "woodcock/base/affine.h"
#include "woodcock/base/random.h"

namespace woodcock::test {
namespace {

void expectNear(Vec3d a, Vec3d b, double tolerance) {
    EXPECT_LE(length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

Vec3d direction(RandomStream& random) {
    const auto r = [&] { return 2 * random.uniform() - 1; };
    return normalize(Vec3d{r(), r(), r()});
}

TEST(Vec, FloorIsFloorOnBothSidesOfZero) {
    for (double v : {0.0, -0.0, 0.5, -0.5, 1.0, -1.0, -1e-300, 0x1p-1074, -7.999999999,
                     2147483647.0, -2147483648.0, 1e9 + 0.25, -1e9 - 0.25})
        EXPECT_EQ(floorToInt(v), static_cast<int>(std::floor(v))) << v;
}

TEST(Vec, LengthNeitherOverflowsNorUnderflows) {
    for (double s : {1e-300, 1e-120, 1.0, 1e120, 1e300})
        EXPECT_NEAR(length(Vec3d{3, 4, 12} * s) / s, 13, 1e-12);
    EXPECT_EQ(length(Vec3d{}), 0);
    expectNear(normalize(Vec3d{0, 3e-200, 4e-200}), {0, 0.6, 0.8}, 1e-15);
}

TEST(Vec, BasisIsOrthonormalAndRightHandedEverywhere) {
    RandomStream random(1);
    std::vector<Vec3d> normals{{0, 0, 1},
                               {0, 0, -1},
                               {1, 0, 0},
                               {0, -1, 0},
                               {1, 0, -0.0},
                               normalize(Vec3d{1e-9, 1e-9, -1}),
                               normalize(Vec3d{1e-17, 0, -1})};
    for (int i = 0; i < 1000; ++i) normals.push_back(direction(random));
    for (Vec3d n : normals) {
        Vec3d s, t;
        orthonormalBasis(n, s, t);
        EXPECT_NEAR(dot(s, s), 1, 1e-14);
        EXPECT_NEAR(dot(t, t), 1, 1e-14);
        EXPECT_NEAR(dot(s, n), 0, 1e-14);
        expectNear(cross(s, t), n, 1e-14);
    }
}

TEST(Vec, BoxesGrowFromEmpty) {
    Box3d box;
    EXPECT_TRUE(box.empty());
    box.add(Box3d{});
    EXPECT_TRUE(box.empty());
    box.add(Vec3d{1, 2, 3});
    EXPECT_FALSE(box.empty());
    box.add(Vec3d{-1, 4, 3});
    EXPECT_EQ(box, (Box3d{{-1, 2, 3}, {1, 4, 3}}));
    EXPECT_TRUE(box.contains({0, 3, 3}));
    EXPECT_FALSE(box.contains({0, 3, 3.1}));
    EXPECT_EQ(box.corner(5), (Vec3d{1, 2, 3}));
    EXPECT_EQ(box.centre(), (Vec3d{0, 3, 3}));
}

TEST(Affine, RotationsAreRightHanded) {
    expectNear(Affine3d::rotate(2, 90).point({1, 0, 0}), {0, 1, 0}, 1e-15);
    expectNear(Affine3d::rotate(0, 90).point({0, 1, 0}), {0, 0, 1}, 1e-15);
    expectNear(Affine3d::rotate(1, 90).point({0, 0, 1}), {1, 0, 0}, 1e-15);
    EXPECT_NEAR(Affine3d::rotate(1, 33).determinant(), 1, 1e-15);
}

TEST(Affine, ProductsApplyTheRightOneFirstAndInversesUndo) {
    RandomStream random(2);
    const auto r = [&] { return 4 * random.uniform() - 2; };
    const auto any = [&] {
        return Affine3d{{Vec3d{r(), r(), r()}, Vec3d{r(), r(), r()}, Vec3d{r(), r(), r()}},
                        {r(), r(), r()}};
    };
    for (int i = 0; i < 1000; ++i) {
        const Affine3d a = any(), b = any();
        const Vec3d p{r(), r(), r()};
        expectNear((a * b).point(p), a.point(b.point(p)), 1e-13);
        if (std::abs(a.determinant()) < 0.1) continue;
        expectNear(a.inverse().point(a.point(p)), p, 1e-11);
        EXPECT_NEAR(a.inverse().determinant() * a.determinant(), 1, 1e-9);
    }
    for (double s : {1e-6, 1e6}) {
        const Affine3d a = Affine3d::translate({1e7, 0, 0}) * Affine3d::scale({s, -s, 2 * s});
        expectNear(a.inverse().vector(a.vector({1, 2, 3})), {1, 2, 3}, 1e-14);
        EXPECT_LT(a.determinant(), 0);
    }
}

TEST(Affine, BoxHoldsTheImageOfEveryCornerTightly) {
    const Affine3d turn = Affine3d::rotate(2, 45);
    const Box3d image = turn.box({{-1, -1, -1}, {1, 1, 1}});
    expectNear(image.lower, {-std::sqrt(2.0), -std::sqrt(2.0), -1}, 1e-15);
    expectNear(image.upper, {std::sqrt(2.0), std::sqrt(2.0), 1}, 1e-15);
}

TEST(Affine, FlawsAreNamed) {
    const double inf = std::numeric_limits<double>::infinity();
    const Affine3d good = Affine3d::translate({1e7, -1, 0}) * Affine3d::rotate(1, 30);
    for (const double s : {1e-49, 1e-6, 1.0, 1e50}) {
        EXPECT_EQ(flawOf(good * Affine3d::scale({s, -s, s})), "") << s;
        EXPECT_EQ(flawOf(Affine3d::scale({s, 1, 1})), "") << s;
    }
    EXPECT_EQ(flawOf(Affine3d::translate({0, inf, 0})), "is not finite");
    EXPECT_EQ(flawOf(Affine3d::scale({1, std::nan(""), 1})), "is not finite");
    EXPECT_EQ(flawOf(Affine3d::scale({1, 1, 1e-315})),
              "has an axis 1e-315 long; 1e-50 to 1e+50 is possible");
    EXPECT_EQ(flawOf(Affine3d::scale({1, 1e308, 1})),
              "has an axis 1e+308 long; 1e-50 to 1e+50 is possible");
    EXPECT_EQ(flawOf(Affine3d::translate({0, 0, -1e60})),
              "moves by 1e+60; up to 1e+50 is possible");
    const char* flat = "is singular: it flattens space (its determinant is 0)";
    EXPECT_EQ(flawOf(Affine3d::scale({1, 0, 1})), flat);
    EXPECT_EQ(flawOf({{Vec3d{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}}), flat);
}

}  // namespace
}  // namespace woodcock::test
