// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/light/emissive_triangles.h"
#include "woodcock/base/statistics.h"
#include "woodcock/proof/oracles/surfaces.h"

namespace woodcock::test {

using namespace light;

namespace {

/// The mean over samples of radiance / pdf times f(direction).
template <class F>
Moments estimate(const MeshLight& light, Vec3d from, F f, int samples = 100000) {
    RandomStream random(17);
    Moments sum;
    for (int i = 0; i < samples; ++i) {
        const LightSample s = draw(light, from, random).light;
        sum.add(s.weight[0] > 0 ? s.weight[0] * f(s.direction) : 0);
    }
    return sum;
}

/// Irradiance on a plane of this normal.
Moments irradiance(const MeshLight& light, Vec3d from, Vec3d normal, int samples = 100000) {
    return estimate(
        light, from, [&](Vec3d d) { return std::max(0.0, dot(d, normal)); }, samples);
}

void expectMean(const Moments& m, double expected, double precision) {
    EXPECT_NEAR(m.mean(), expected, 4 * m.standardError() + 1e-6 * expected);
    EXPECT_LT(m.standardError(), precision * expected);
}

TEST(MeshLight, IrradianceOfARectangle) {
    Triangles rectangle;
    addRectangle(rectangle, {0, 0, 1}, {0, 2, 0}, {3, 0, 0});  // faces down
    const MeshLight light(rectangle);
    const std::vector<Vec3d> corners{{0, 0, 1}, {3, 0, 1}, {3, 2, 1}, {0, 2, 1}};
    for (Vec3d from : {Vec3d{0, 0, 0}, Vec3d{1.5, 1, 0}, Vec3d{1.2, 0.4, 0.9}, Vec3d{-4, 7, -2}}) {
        expectMean(irradiance(light, from, {0, 0, 1}),
                   oracle::polygonIrradiance(corners, from, {0, 0, 1}), 0.004);
        EXPECT_EQ(irradiance(light, from, {0, 0, -1}, 1000).mean(), 0);
    }
}

TEST(MeshLight, IrradianceOfADisk) {
    constexpr int sides = 200;
    Triangles fan;
    const auto rim = [](int i) {
        return Vec3d{std::cos(2 * pi * i / sides), -std::sin(2 * pi * i / sides), 0};
    };
    for (int i = 0; i < sides; ++i) fan.push_back({{Vec3d{}, rim(i), rim(i + 1)}, Rgb(1.0f)});
    for (double scale : {1e-4, 1.0, 1e5})
        for (double height : {0.05, 1.0, 20.0}) {
            // 200 sides lack 2e-4 of the area
            const MeshLight light(moved(fan, scale, {1, 2, 3}));
            const Vec3d from = Vec3d{1, 2, 3} - Vec3d{0, 0, height * scale};
            const Moments m = irradiance(light, from, {0, 0, 1});
            const double expected = oracle::diskIrradiance(1, height, 0);
            EXPECT_NEAR(m.mean(), expected, 4 * m.standardError() + 2e-4 * expected) << height;
            EXPECT_LT(m.standardError(), 0.004 * expected) << height;
        }
}

TEST(MeshLight, IrradianceOfASphere) {
    const int rings = 24;
    const MeshLight light(sphere({0, 0, 0}, rings));
    // The circle through a face's corners is no wider than an edge: faces stay outside this radius.
    const double inner = std::cos(pi / rings);
    for (double distance : {1.5, 4.0, 100.0}) {
        RandomStream random(8);
        const Vec3d towards = direction(random);
        const Moments m = irradiance(light, towards * distance, -towards);
        const double expected = oracle::sphereIrradiance(1, distance, 1);
        EXPECT_LT(m.mean(), expected + 4 * m.standardError()) << distance;
        EXPECT_GT(m.mean(), expected * inner * inner - 4 * m.standardError()) << distance;
        EXPECT_LT(m.standardError(), 0.01 * expected) << distance;
    }
}

TEST(MeshLight, InsideAClosedMeshRadianceComesFromEverywhere) {
    RandomStream random(11);
    for (double scale : {1e-4, 1.0, 1e5}) {
        const MeshLight room(moved(cube({}, true), scale, {5, 5, 5}));
        const MeshLight lamp(moved(cube({}, false), scale, {5, 5, 5}));
        for (int i = 0; i < 4; ++i) {
            Vec3d p{random.uniform(), random.uniform(), random.uniform()};
            if (i == 3) p.x = 1 - 1e-5;  // by the wall
            const Vec3d from = Vec3d{5, 5, 5} + p * scale, normal = direction(random);
            expectMean(estimate(room, from, [](Vec3d) { return 1.0; }), 4 * pi, 0.005);
            expectMean(irradiance(room, from, normal), pi, 0.01);
            EXPECT_EQ(irradiance(lamp, from, normal, 100).mean(), 0);
        }
    }
}

TEST(MeshLight, TouchingItsPlaneItIsAHalfSpace) {
    Triangles wall;
    addRectangle(wall, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    const Triangle one{{Vec3d{-1, -1, 0}, Vec3d{1, -1, 0}, Vec3d{0, 1, 0}}, Rgb(1.0f)};
    for (double height : {1e-6, 2e-7, 1e-7, 1e-9, 1e-14, 1e-30})
        for (const Triangles& triangles : {wall, Triangles{one}}) {
            SCOPED_TRACE(height);
            const MeshLight light(triangles);
            const Vec3d from{0.1, 0.2, height};
            expectMean(irradiance(light, from, {0, 0, -1}), pi, 0.005);
            for (int axis = 0; axis < 3; ++axis)
                expectMean(estimate(light, from, [&](Vec3d d) { return d[axis] * d[axis]; }),
                           2 * pi / 3, 0.005);
        }
}

TEST(MeshLight, OfManyTrianglesPrefersThoseThatMatter) {
    RandomStream random(6);
    const Triangles triangles = cloud(100000, 0.003, random);
    const MeshLight light(triangles);
    std::vector<double> below;  // sums of power, for choosing by it alone
    for (const Triangle& t : triangles) {
        const Vec3d n = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
        below.push_back(t.radiance[0] * length(n) / 2 + (below.empty() ? 0 : below.back()));
    }
    const auto byPower = [&](Vec3d from, double u, double u0, double u1) {
        const auto found = std::upper_bound(below.begin(), below.end(), u * below.back());
        const Triangle& t = triangles[static_cast<std::size_t>(found - below.begin())];
        const double root = std::sqrt(u0);
        const Vec3d e1 = t.corner[1] - t.corner[0], e2 = t.corner[2] - t.corner[0];
        const Vec3d d = t.corner[0] + e1 * (root * (1 - u1)) + e2 * (root * u1) - from;
        const double r = length(d), cosine = -dot(normalize(cross(e1, e2)), d) / r;
        return below.back() * (t.bothSides ? std::abs(cosine) : std::max(cosine, 0.0)) / (r * r);
    };
    // What remains of the variance; far away, where only dark sides are saved, a good half.
    for (const auto& [distance, part] :
         {std::pair{0.0, 0.05}, std::pair{0.7, 0.05}, std::pair{1.2, 0.3}, std::pair{50.0, 0.7}}) {
        const Vec3d from = direction(random) * distance;
        const Moments tree = estimate(light, from, [](Vec3d) { return 1.0; });
        Moments power;
        for (int i = 0; i < 1000000; ++i)
            power.add(byPower(from, random.uniform(), random.uniform(), random.uniform()));
        EXPECT_NEAR(tree.mean(), power.mean(),
                    4 * std::hypot(tree.standardError(), power.standardError()))
            << distance;
        EXPECT_LT(tree.standardError(), 0.02 * tree.mean()) << distance;
        EXPECT_LT(tree.variance(), part * power.variance()) << distance;
    }
}

}  // namespace
}  // namespace woodcock::test
