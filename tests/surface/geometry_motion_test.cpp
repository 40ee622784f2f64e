// SPDX-License-Identifier: Apache-2.0
// Surfaces that move, against the same surfaces at rest where they are at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "woodcock/base/random.h"
#include "woodcock/mesh/triangle_mesh.h"
#include "woodcock/surface/geometry.h"

namespace woodcock::test {

using namespace surface;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const std::vector<double> wholeShutter{0, 1};

std::shared_ptr<const mesh::SurfaceMesh> cube() {
    auto cube = std::make_shared<mesh::SurfaceMesh>();
    for (int i = 0; i < 8; ++i)
        cube->mesh.points.push_back(
            {i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
    cube->mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                            {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return cube;
}

/// Turning, growing, passing by, on an orbit, jumping, and still.
Affine3d placeOf(std::size_t i, double u) {
    const Affine3d start = Affine3d::translate({4.0 * double(i), 0, 0});
    switch (i) {
        case 0:
            return start * Affine3d::rotate(1, 170 * u) * Affine3d::rotate(0, 20);
        case 1:
            return start * Affine3d::scale(Vec3d{1, 1, 1} * (0.2 + u * u));
        case 2:
            return start * Affine3d::translate({0, 9 * u - 4, 3 * u});
        case 3:
            return Affine3d::rotate(2, 120 * u) * start * Affine3d::scale({0.1, 0.1, 0.3});
        case 4:
            return start * Affine3d::translate({0, u < 0.5 ? -3.0 : 3.0, 0});
        default:
            return start;
    }
}

/// Where a thing of the `start` moves to.
std::shared_ptr<const MovingTransform> movement(const std::function<Affine3d(double)>& placeAt,
                                                const Affine3d& start, bool jumps) {
    const Affine3d back = start.inverse();
    const auto at = [&](double u) { return placeAt(u) * back; };
    const auto before = [&](double u) { return placeAt(u == 0.5 ? 0.4999999 : u) * back; };
    const std::vector<double> halves{0, 0.5, 1};
    return MovingTransform::follow(at, before, jumps ? halves : wholeShutter, start.translation);
}

/// At rest as it is at time 0.5, and moving; or still, where it moves to at time u.
std::vector<ShapeInstance> instancesAt(double u, bool moving) {
    std::vector<ShapeInstance> instances;
    for (std::size_t i = 0; i < 6; ++i)
        for (std::uint32_t shape = 0; shape < 3; ++shape) {
            const auto placeAt = [=](double v) {
                return Affine3d::translate({0, 0, 5.0 * shape}) * placeOf(i, v);
            };
            const Affine3d rest = placeAt(0.5);
            const auto way = movement(placeAt, rest, i == 4);
            instances.push_back(
                {shape, static_cast<std::uint32_t>(i), rest, moving ? way : nullptr});
            if (!moving && way) instances.back().worldFromObject = way->at(u) * rest;
        }
    return instances;
}

const std::vector<Shape> shapes{cube(), UnitSphere(), UnitDisk()};

}  // namespace

TEST(MovingGeometry, IsMetWhereItIsAtTheTimeOfTheRay) {
    const Geometry moving(shapes, instancesAt(0, true));
    EXPECT_TRUE(moving.moves());
    RandomStream random(1);
    int hits = 0;
    for (int t = 0; t < 60; ++t) {
        const auto time = static_cast<float>(t < 2 ? t : random.uniform());
        const Geometry still(shapes, instancesAt(double{time}, false));
        EXPECT_FALSE(still.moves());
        const std::vector<bool> closed(6, true);
        for (int i = 0; i < 400; ++i) {
            const Vec3d from{60 * random.uniform() - 20, 60 * random.uniform() - 30,
                             60 * random.uniform() - 25};
            const Vec3d to{26 * random.uniform() - 6, 12 * random.uniform() - 6,
                           14 * random.uniform() - 2};
            SurfaceHit a, b;
            const bool met = moving.intersect(from, to - from, infinity, nullptr, a, time);
            ASSERT_EQ(met, still.intersect(from, to - from, infinity, nullptr, b));
            EXPECT_EQ(moving.enclosing(to, closed, time), still.enclosing(to, closed));
            if (!met) continue;
            ++hits;
            EXPECT_EQ(a.time, time);
            EXPECT_EQ(a.instance, b.instance);
            EXPECT_EQ(a.primitive, b.primitive);
            EXPECT_EQ(a.t, b.t);
            EXPECT_EQ(a.position, b.position);
            EXPECT_EQ(a.normal, b.normal);
            // And on from there.
            SurfaceHit onA, onB;
            const bool on = moving.intersect(a.position, to - from, infinity, &a, onA, time);
            ASSERT_EQ(on, still.intersect(b.position, to - from, infinity, &b, onB));
            if (on) {
                EXPECT_EQ(onA.t, onB.t);
            }
        }
    }
    EXPECT_GT(hits, 3000);
}

TEST(MovingGeometry, CoincidesWithWhatMovesAlong) {
    // A ball's cube on a disk, both moving along the same line.
    const auto along = [](double u) { return Affine3d::translate({4 * u, 2 * u, -u}); };
    const auto onTop = [&](double u) { return along(u) * Affine3d::translate({0, 1, 0}); };
    const std::vector<ShapeInstance> instances{{0, 0, onTop(0), movement(onTop, onTop(0), false)},
                                               {2, 1, along(0), movement(along, along(0), false)}};
    const Geometry geometry(shapes, instances);
    for (const float time : {0.0f, 0.3f, 0.5f, 0.77f, 1.0f}) {
        const Vec3d above = along(double{time}).point({0.3, 1, 0.1});
        SurfaceHit hit;
        ASSERT_TRUE(geometry.intersect(above, {0, -1, 0}, infinity, nullptr, hit, time));
        EXPECT_NEAR(hit.t, 1, 1e-6);
        EXPECT_TRUE(hit.coincident.any) << time;
        std::vector<CoincidentSurface> all;
        geometry.coincidentSurfaces(hit, all);
        EXPECT_EQ(all.size(), 2u) << time;
        SurfaceHit next;
        EXPECT_FALSE(geometry.intersect(hit.position, {0, -1, 0}, infinity, &hit, next, time));
    }
}

TEST(MovingGeometry, BoundsHoldForTheWholeShutter) {
    const Geometry moving(shapes, instancesAt(0, true));
    for (int i = 0; i <= 20; ++i) {
        const Geometry still(shapes, instancesAt(i / 20.0, false));
        EXPECT_TRUE(moving.bounds().contains(still.bounds().lower));
        EXPECT_TRUE(moving.bounds().contains(still.bounds().upper));
    }
}

}  // namespace woodcock::test
