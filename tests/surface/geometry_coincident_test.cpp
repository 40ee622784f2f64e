// SPDX-License-Identifier: Apache-2.0
// Surfaces in one place, as rays find them.
#include <gtest/gtest.h>

#include <limits>

#include "tests/surface/brute_force_rays.h"
#include "woodcock/surface/geometry.h"

namespace woodcock::test {

using namespace mesh;
using namespace surface;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Shape box(Vec3d lower, Vec3d upper) {
    return std::make_shared<const SurfaceMesh>(boxMesh({lower, upper}));
}

std::vector<CoincidentSurface> togetherAt(const Geometry& geometry, const SurfaceHit& hit) {
    std::vector<CoincidentSurface> found;
    geometry.coincidentSurfaces(hit, found);
    return found;
}

/// The same body by other numbers: of floats that are none in the other's frame, and rotated.
class SameBody : public testing::TestWithParam<std::pair<double, Vec3d>> {};

TEST_P(SameBody, IsFoundWholeByEveryRayAndLeftAtOnce) {
    const auto [scale, place] = GetParam();
    const Affine3d there = Affine3d::translate(place) * Affine3d::rotate(0, 10) *
                           Affine3d::rotate(1, 20) * Affine3d::rotate(2, 30) *
                           Affine3d::scale({scale, scale, scale});
    const Geometry geometry(
        {box({-0.7, -0.7, -0.7}, {0.7, 0.7, 0.7}), box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}),
         UnitSphere{}},
        {{0, 0, there},
         {1, 1, there * Affine3d::scale({7, 7, 7})},
         {0, 2, there * Affine3d::rotate(1, 90)},
         {2, 3, there * Affine3d::scale({0.5, 0.5, 0.5})},
         {2, 4, there * Affine3d::rotate(2, 45) * Affine3d::scale({0.5, 0.5, 0.5})}});
    RandomStream random(1);
    int outer = 0, inner = 0;
    for (int n = 0; n < 20000; ++n) {
        const Vec3d from = place + randomDirection(random) * (3 * scale);
        const Vec3d to = place + randomPoint(random, 0.4 * scale);
        SurfaceHit hit, next;
        Vec3d direction = normalize(to - from);
        ASSERT_TRUE(geometry.intersect(from, direction, infinity, nullptr, hit));
        ASSERT_TRUE(hit.coincident.any);
        const std::vector<CoincidentSurface> outside = togetherAt(geometry, hit);
        // Beside an edge it may be the body's neighbouring face of which one more is found.
        if (outside.size() != 3) continue;
        ++outer;
        ASSERT_TRUE(geometry.intersect(hit.position, direction, infinity, &hit, next));
        EXPECT_GT(next.t, 1e-3 * scale) << "the same place again";
        if (next.object < 3) continue;
        ++inner;
        ASSERT_TRUE(next.coincident.any);
        const std::vector<CoincidentSurface> ball = togetherAt(geometry, next);
        ASSERT_EQ(ball.size(), 2U);
        EXPECT_EQ(ball[0].object, 3U);
        EXPECT_EQ(ball[1].object, 4U);
        for (const CoincidentSurface& one : ball) {
            const SurfaceHit own = geometry.inPlaceOf(next, one);
            EXPECT_EQ(own.object, one.object);
            EXPECT_EQ(own.position, next.position);
        }
        // From the ball outwards, the walls are met again, all three in one place.
        const Vec3d back = -direction;
        ASSERT_TRUE(geometry.intersect(next.position, back, infinity, &next, hit));
        EXPECT_LT(hit.object, 3U);
        EXPECT_TRUE(hit.coincident.any);
    }
    EXPECT_GT(outer, 19000);
    EXPECT_GT(inner, 1000);
}
INSTANTIATE_TEST_SUITE_P(Anywhere, SameBody,
                         testing::Values(std::pair(1.0, Vec3d{}), std::pair(1e-4, Vec3d{}),
                                         std::pair(1e5, Vec3d{}),
                                         std::pair(1.0, Vec3d{1e6, -1e6, 1e6}),
                                         std::pair(1e-2, Vec3d{0, 30, 0})));

TEST(CoincidentSurfaces, AGapThatFloatsCanTellIsAGap) {
    const Geometry geometry({box({-0.7, 0, -0.7}, {0.7, 1, 0.7}), InfinitePlane{}},
                            {{0, 0, Affine3d::translate({0, 1e-6, 0})}, {1, 1, Affine3d{}}});
    SurfaceHit hit, next;
    ASSERT_TRUE(geometry.intersect({0.1, 0.5, 0.2}, {0, -1, 0}, infinity, nullptr, hit));
    EXPECT_EQ(hit.object, 0U);
    EXPECT_FALSE(hit.coincident.any && togetherAt(geometry, hit).size() > 1);
    ASSERT_TRUE(geometry.intersect(hit.position, {0, -1, 0}, infinity, &hit, next));
    EXPECT_EQ(next.object, 1U);
    EXPECT_NEAR(next.t, 1e-6, 1e-12);
}

TEST(CoincidentSurfaces, OnlyWhereBothAre) {
    const Geometry geometry({box({-1, 0, -1}, {0.25, 1, 1}), box({-0.25, 0, -1}, {1, 0.5, 1})},
                            {{0, 0, Affine3d{}}, {1, 1, Affine3d{}}});
    for (const double x : {-0.5, 0.1, 0.5}) {
        SurfaceHit hit;
        ASSERT_TRUE(geometry.intersect({x, -1, 0.3}, {0, 1, 0}, infinity, nullptr, hit));
        const std::size_t count = hit.coincident.any ? togetherAt(geometry, hit).size() : 1;
        EXPECT_EQ(count, x == 0.1 ? 2U : 1U) << x;
    }
}

TEST(CoincidentSurfaces, FacesKnowWhichWayTheyLook) {
    const Geometry geometry({box({0, 0, 0}, {1, 1, 1})},
                            {{0, 0, Affine3d{}}, {0, 1, Affine3d::translate({1, 0, 0})}});
    SurfaceHit hit;
    ASSERT_TRUE(geometry.intersect({0.5, 0.3, 0.6}, {1, 0, 0}, infinity, nullptr, hit));
    ASSERT_TRUE(hit.coincident.any);
    const std::vector<CoincidentSurface> faces = togetherAt(geometry, hit);
    ASSERT_EQ(faces.size(), 2U);
    EXPECT_EQ(faces[0].normal.x, 1);
    EXPECT_EQ(faces[1].normal.x, -1);
}

}  // namespace
}  // namespace woodcock::test
