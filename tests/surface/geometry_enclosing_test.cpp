// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/surface/brute_force_rays.h"
#include "woodcock/surface/geometry.h"

namespace woodcock::test {

using namespace mesh;
using namespace surface;

namespace {

using Instances = std::vector<std::uint32_t>;

std::shared_ptr<const SurfaceMesh> box(double half) {
    return std::make_shared<const SurfaceMesh>(
        boxMesh({{-half, -half, -half}, {half, half, half}}));
}

TEST(GeometryEnclosing, NestedAndOverlappingShapesInOrder) {
    const Geometry geometry({UnitSphere{}, box(1), InfinitePlane{}, UnitDisk{}},
                            {{1, 0, Affine3d::scale({4, 4, -4})},
                             {0, 1, Affine3d::translate({0, 1, 0})},
                             {1, 2, Affine3d::translate({1, 1, 0}) * Affine3d::rotate(2, 45)},
                             {2, 3, Affine3d::translate({0, -2, 0})},
                             {3, 4, {}},
                             {0, 5, Affine3d::scale({0.5, 3, 0.5})}});
    const std::vector<bool> all(6, true);
    EXPECT_EQ(geometry.enclosing({0, 1.1, 0}, all), (Instances{0, 1, 2, 5}));
    EXPECT_EQ(geometry.enclosing({2, 1, 0}, all), (Instances{0, 2}));
    EXPECT_EQ(geometry.enclosing({0, -3, 0}, all), (Instances{0, 3}));
    EXPECT_EQ(geometry.enclosing({0, -300, 0}, all), (Instances{3}));
    EXPECT_EQ(geometry.enclosing({0, 300, 0}, all), (Instances{}));
    EXPECT_EQ(geometry.enclosing({0, 1.1, 0}, {true, false, false, false, false, true}),
              (Instances{0, 5}));
}

/// A body of revolution with a hollow in it: whether a point is inside is known.
TEST(GeometryEnclosing, AsTheShapeSaysNearEdgesToo) {
    // A cup: its outside up, over the rim, and its hollow down again.
    const std::vector<std::array<double, 2>> cup{{0, 0},   {1, 0},     {1, 2},
                                                 {0.8, 2}, {0.8, 0.2}, {0, 0.2}};
    const SurfaceMesh mesh = latheMesh(cup, 64, 30);
    ASSERT_TRUE(checkClosed(mesh.mesh).closed);
    const Geometry geometry({std::make_shared<const SurfaceMesh>(mesh)}, {{0, 0, {}}});
    const double narrow = std::cos(pi / 64);  // where the polygon's sides are
    RandomStream random(4);
    int inside = 0;
    for (int i = 0; i < 20'000; ++i) {
        Vec3d p = randomPoint(random, 1.2) + Vec3d{0, 1, 0};
        if (i % 2) p = {0, p.y, 0};         // on the axis, where sides come together
        if (i % 5 == 1) p = {p.x, 0.1, 0};  // in the plane of corners
        const double r = std::hypot(p.x, p.z);
        const bool within = p.y > 0 && p.y < 2 && r < narrow && (r > 0.8 || p.y < 0.2);
        const bool near = r > narrow - 1e-9 ? r < 1 + 1e-9 : (r > 0.8 * narrow && r < 0.8);
        if (near) continue;
        inside += within;
        ASSERT_EQ(!geometry.enclosing(p, {true}).empty(), within)
            << p.x << " " << p.y << " " << p.z;
    }
    EXPECT_GT(inside, 1000);
}

/// Right at a surface: a little before it and behind it, also beside edges and corners.
TEST(GeometryEnclosing, BesideSurfacesAtAllScales) {
    for (const double scale : {1e-4, 1.0, 1e5})
        for (const Vec3d place : {Vec3d{}, Vec3d{100, -50, 25} * scale}) {
            const Geometry geometry(
                {box(1)},
                {{0, 0, Affine3d::translate(place) * Affine3d::scale({scale, scale, scale})}});
            RandomStream random(6);
            for (int i = 0; i < 2000; ++i) {
                Vec3d p = randomPoint(random, 0.999);
                if (i % 3 == 1) p.y = 0.999999;
                if (i % 3 == 2) p = {0.999999, -0.999999, 0.999999};
                for (const double out : {-1e-6, 1e-6}) {
                    Vec3d q = p;
                    q.x = 1 + out;
                    const bool found = !geometry.enclosing(place + q * scale, {true}).empty();
                    ASSERT_EQ(found, out < 0) << i << " scale " << scale;
                }
            }
        }
}

/// A mesh of two bodies, one in the other, facing the same way, holds both; facing apart, a shell.
TEST(GeometryEnclosing, SignsAreCounted) {
    SurfaceMesh two = boxMesh({{-2, -2, -2}, {2, 2, 2}});
    SurfaceMesh inner = boxMesh({{-1, -1, -1}, {1, 1, 1}});
    const auto join = [](SurfaceMesh a, const SurfaceMesh& b) {
        const auto first = static_cast<std::uint32_t>(a.mesh.points.size());
        a.mesh.points.insert(a.mesh.points.end(), b.mesh.points.begin(), b.mesh.points.end());
        for (const auto& [i, j, k] : b.mesh.triangles)
            a.mesh.triangles.push_back({first + i, first + j, first + k});
        return std::make_shared<const SurfaceMesh>(a);
    };
    const auto both = join(two, inner);
    flip(inner);
    const auto shell = join(two, inner);
    const Geometry geometry({both, shell}, {{0, 0, {}}, {1, 1, {}}});
    EXPECT_EQ(geometry.enclosing({0.1, 0.2, 0.3}, {true, true}), (Instances{0}));
    EXPECT_EQ(geometry.enclosing({1.1, 0.2, 0.3}, {true, true}), (Instances{0, 1}));
    EXPECT_EQ(geometry.enclosing({2.1, 0.2, 0.3}, {true, true}), (Instances{}));
}

}  // namespace
}  // namespace woodcock::test
