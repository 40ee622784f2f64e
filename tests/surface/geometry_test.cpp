// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/geometry.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/expect_error.h"
#include "tests/surface/brute_force_rays.h"

namespace woodcock::test {

using namespace mesh;
using namespace surface;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::shared_ptr<const SurfaceMesh> share(SurfaceMesh mesh) {
    return std::make_shared<const SurfaceMesh>(std::move(mesh));
}

/// Triangles of all sizes, anywhere in a cube, with texture coordinates.
SurfaceMesh randomTriangles(RandomStream& random, int count) {
    SurfaceMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3d middle = randomPoint(random, 1);
        const auto first = static_cast<std::uint32_t>(mesh.mesh.points.size());
        const double size = std::exp(-4 * random.uniform());
        for (int k = 0; k < 3; ++k)
            mesh.mesh.points.push_back((middle + randomPoint(random, size)).as<float>());
        mesh.mesh.triangles.push_back({first, first + 1, first + 2});
        const auto number = [&] { return static_cast<float>(random.uniform()); };
        mesh.uvs.push_back(
            {Vec2f{number(), number()}, Vec2f{number(), number()}, Vec2f{number(), number()}});
    }
    return mesh;
}

Geometry randomScene(RandomStream& random, double scale, Vec3d place) {
    std::vector<Shape> shapes{UnitSphere{}, UnitDisk{}, InfinitePlane{},
                              share(randomTriangles(random, 60)),
                              share(boxMesh({{0, 0, 0}, {1, 2, 3}}))};
    std::vector<ShapeInstance> instances;
    for (std::uint32_t i = 0; i < 24; ++i) {
        const std::uint32_t shape = i == 0 ? 2 : std::array<std::uint32_t, 4>{0, 1, 3, 4}[i % 4];
        instances.push_back(
            {shape, 100 + i,
             Affine3d::translate(place) *
                 randomTransform(random, scale * 0.5, shape == 2 ? 3 * scale : 2 * scale)});
    }
    return Geometry(std::move(shapes), std::move(instances));
}

struct Setting {
    double scale;
    Vec3d place;
};
void PrintTo(const Setting& s, std::ostream* out) {
    *out << "scale " << s.scale << " at " << s.place.x;
}

class GeometryOracle : public testing::TestWithParam<Setting> {};

TEST_P(GeometryOracle, RaysMeetWhatBruteForceMeets) {
    const auto [scale, place] = GetParam();
    // Positions that far away are known to this alone.
    const double tolerance = 1e-9 * scale + 1e-14 * length(place);
    RandomStream random(11);
    int hits = 0, unsure = 0;
    for (int variant = 0; variant < 10; ++variant) {
        const Geometry geometry = randomScene(random, scale, place);
        for (int ray = 0; ray < 2000; ++ray) {
            const Vec3d o = place + randomPoint(random, 4 * scale);
            // Of any length: t counts in these.
            const Vec3d d = randomDirection(random) * std::exp(4 * random.uniform() - 2);
            const OracleHit expected = bruteForce(geometry, o, d);
            SurfaceHit hit;
            const bool found = geometry.intersect(o, d, infinity, nullptr, hit);
            if (expected.nearEdge < 1e-5) {
                ++unsure;
                continue;
            }
            ASSERT_EQ(found, std::isfinite(expected.t)) << variant << " " << ray;
            if (!found) continue;
            ++hits;
            ASSERT_EQ(hit.instance, expected.instance);
            ASSERT_EQ(hit.primitive, expected.primitive);
            EXPECT_EQ(hit.object, 100 + hit.instance);
            const double slope = std::abs(dot(hit.normal, d)) / length(d);
            ASSERT_NEAR(hit.t * length(d), expected.t * length(d), tolerance / slope);
            EXPECT_LT(length(hit.position - (o + d * hit.t)), tolerance / slope);
            EXPECT_LT(length(hit.normal - expected.normal), 1e-8 + 1e-13 * length(place) / scale);
            EXPECT_EQ(hit.shadingNormal, hit.normal);
            // Not beyond its own t.
            SurfaceHit nearer;
            EXPECT_FALSE(geometry.intersect(o, d, hit.t * (1 - 1e-6), nullptr, nearer) &&
                         nearer.t >= hit.t * (1 - 1e-6));
        }
    }
    EXPECT_GT(hits, 10000);
    EXPECT_LT(unsure, 2000);
}

INSTANTIATE_TEST_SUITE_P(Scales, GeometryOracle,
                         testing::Values(Setting{1, {}}, Setting{1e-4, {}}, Setting{1e5, {}},
                                         Setting{1, {1e7, -2e7, 3e7}}, Setting{1e-12, {}},
                                         Setting{1e12, {}}));

TEST(Geometry, TextureCoordinatesAreInterpolated) {
    RandomStream random(3);
    const auto mesh = share(randomTriangles(random, 40));
    const Geometry geometry({mesh}, {{0, 0, {}}});
    int hits = 0;
    for (int ray = 0; ray < 2000; ++ray) {
        const Vec3d o = randomPoint(random, 1), d = randomDirection(random);
        const OracleHit expected = bruteForce(geometry, o, d);
        SurfaceHit hit;
        if (!geometry.intersect(o, d, infinity, nullptr, hit) || expected.nearEdge < 1e-5) continue;
        ++hits;
        const auto& uv = mesh->uvs[hit.primitive];
        const double b0 = 1 - expected.b1 - expected.b2;
        EXPECT_NEAR(hit.u, b0 * uv[0].u + expected.b1 * uv[1].u + expected.b2 * uv[2].u, 1e-7);
        EXPECT_NEAR(hit.v, b0 * uv[0].v + expected.b1 * uv[1].v + expected.b2 * uv[2].v, 1e-7);
    }
    EXPECT_GT(hits, 200);
}

TEST(Geometry, CoordinatesOfPrimitives) {
    const Geometry geometry({UnitSphere{}, UnitDisk{}, InfinitePlane{}},
                            {{0, 0, Affine3d::scale({2, 2, 2})},
                             {1, 1, Affine3d::translate({10, 0, 0})},
                             {2, 2, Affine3d::translate({0, -7, 0})}});
    SurfaceHit hit;
    ASSERT_TRUE(geometry.intersect({5, 0, 0}, {-1, 0, 0}, infinity, nullptr, hit));
    EXPECT_EQ(hit.t, 3);
    EXPECT_EQ(hit.u, 0);
    EXPECT_EQ(hit.v, 0.5);
    ASSERT_TRUE(geometry.intersect({0, 0, -5}, {0, 0, 1}, infinity, nullptr, hit));
    EXPECT_DOUBLE_EQ(hit.u, 0.25);
    ASSERT_TRUE(geometry.intersect({0, 9, 0}, {0, -1, 0}, infinity, nullptr, hit));
    EXPECT_EQ(hit.v, 1);
    ASSERT_TRUE(geometry.intersect({10.5, 1, -0.25}, {0, -1, 0}, infinity, nullptr, hit));
    EXPECT_EQ(hit.object, 1u);
    // Of the square around the disk.
    EXPECT_EQ(hit.u, 0.75);
    EXPECT_EQ(hit.v, 0.625);
    EXPECT_EQ(hit.normal, (Vec3d{0, 1, 0}));
    ASSERT_TRUE(geometry.intersect({11.5, 1, 3e5}, {0, -1, 0}, infinity, nullptr, hit));
    EXPECT_EQ(hit.object, 2u);
    EXPECT_EQ(hit.t, 8);
    EXPECT_EQ(hit.v, -3e5);
    EXPECT_FALSE(geometry.intersect({11.5, 1, 3e5}, {0, -1, 0}, 7.999, nullptr, hit));
    EXPECT_FALSE(geometry.intersect({11.5, 1, 3e5}, {1, 0, 0}, infinity, nullptr, hit));
    EXPECT_EQ(geometry.bounds(), (Box3d{{-2, -2, -2}, {11, 2, 2}}));
}

/// What is far larger costs what is small no digit: each is found in its own frame.
TEST(Geometry, ASmallThingOnAWideGroundIsExact) {
    const auto ground = share(rectangleMesh(1e5, 1e5));
    const auto box = share(boxMesh({{0, 0, 0}, {1, 1, 1}}));
    const Vec3d place{41234.5, 0.25, -38123.25};
    const Geometry geometry({ground, box}, {{0, 0, {}}, {1, 1, Affine3d::translate(place)}});
    RandomStream random(5);
    const Vec3d eye{-49000, 900, 47000};
    for (int i = 0; i < 1000; ++i) {
        const double x = random.uniform(), z = random.uniform();
        const Vec3d target = place + Vec3d{x, 1, z};
        SurfaceHit hit;
        ASSERT_TRUE(geometry.intersect(eye, target - eye, infinity, nullptr, hit));
        ASSERT_EQ(hit.object, 1u) << x << " " << z;
        EXPECT_LT(length(hit.position - target), 1e-6);
        // From there down, through the box, to its floor, and to the ground below.
        const SurfaceHit top = hit;
        ASSERT_TRUE(geometry.intersect(top.position, {0, -1, 0}, infinity, &top, hit));
        EXPECT_EQ(hit.object, 1u);
        EXPECT_NEAR(hit.t, 1, 1e-9);
        const SurfaceHit floor = hit;
        ASSERT_TRUE(geometry.intersect(floor.position, {0, -1, 0}, infinity, &floor, hit));
        EXPECT_EQ(hit.object, 0u);
        EXPECT_NEAR(hit.t, 0.25, 1e-9);
    }
}

TEST(Geometry, NormalsPointOutwardsThoughMirrored) {
    const auto box = share(boxMesh({{-1, -1, -1}, {1, 1, 1}}));
    for (const double sign : {1.0, -1.0}) {
        const Geometry geometry(
            {box, UnitSphere{}},
            {{0, 0, Affine3d::scale({sign, 1, 2})},
             {1, 1, Affine3d::translate({0, 5, 0}) * Affine3d::scale({1, 1, sign})}});
        SurfaceHit hit;
        ASSERT_TRUE(geometry.intersect({5, 0.1, 0.2}, {-1, 0, 0}, infinity, nullptr, hit));
        EXPECT_EQ(hit.normal, (Vec3d{1, 0, 0}));
        ASSERT_TRUE(geometry.intersect({0.1, 0.2, 0}, {-1, 0, 0}, infinity, nullptr, hit));
        EXPECT_EQ(hit.normal, (Vec3d{-1, 0, 0}));
        ASSERT_TRUE(geometry.intersect({0, 9, 0}, {0, -1, 0}, infinity, nullptr, hit));
        EXPECT_EQ(hit.normal, (Vec3d{0, 1, 0}));
    }
}

TEST(Geometry, ShadingNormalsAreInterpolatedOnTheSurfacesSide) {
    SurfaceMesh flat = rectangleMesh(2, 2);
    const Vec3f up{0, 1, 0}, tilted{0.6f, 0.8f, 0}, below{0.9798f, -0.2f, 0};
    const auto hitOf = [&](const std::array<Vec3f, 3>& normals, const Affine3d& m) {
        flat.normals = {normals, normals};
        const Geometry geometry({share(flat)}, {{0, 0, m}});
        SurfaceHit hit;
        EXPECT_TRUE(geometry.intersect({0.3, 1, 0.1}, {0, -1, 0}, infinity, nullptr, hit));
        EXPECT_NEAR(length(hit.shadingNormal), 1, 1e-12);
        EXPECT_GT(dot(hit.shadingNormal, hit.normal), 0);
        return hit;
    };
    EXPECT_EQ(hitOf({up, up, up}, {}).shadingNormal, (Vec3d{0, 1, 0}));
    EXPECT_LT(length(hitOf({tilted, tilted, tilted}, {}).shadingNormal - Vec3d{0.6, 0.8, 0}), 1e-7);
    // Normals of a wider surface are steeper: covectors.
    const Vec3d wide = hitOf({tilted, tilted, tilted}, Affine3d::scale({3, 1, 1})).shadingNormal;
    EXPECT_LT(length(wide - normalize(Vec3d{0.2, 0.8, 0})), 1e-7);
    EXPECT_EQ(hitOf({-up, -up, -up}, {}).shadingNormal, (Vec3d{0, 1, 0}));  // all turned over
    const Vec3d bent = hitOf({up, below, below}, {}).shadingNormal;
    EXPECT_GT(bent.x, 0);
    EXPECT_EQ(hitOf({Vec3f{}, Vec3f{}, Vec3f{}}, {}).shadingNormal, (Vec3d{0, 1, 0}));
}

TEST(Geometry, TransformsThatAreNoneAreErrors) {
    const auto make = [](const Affine3d& m) { Geometry({UnitSphere{}}, {{0, 7, {}}, {0, 8, m}}); };
    Affine3d nan;
    nan.translation.x = std::nan("");
    expectError(ErrorKind::Input, "instance 1 (object 8) is not finite", [&] { make(nan); });
    expectError(ErrorKind::Input, "instance 1 (object 8) flattens its shape", [&] {
        make(Affine3d::scale({1, 0, 1}));
    });
    Affine3d flat;
    flat.column[2] = {1, 1, 0};
    expectError(ErrorKind::Input, "flattens its shape", [&] { make(flat); });
    EXPECT_NO_THROW(make(Affine3d::scale({1e-6, 1e6, 1})));
}

TEST(Geometry, NothingIsMetWhereThereIsNothing) {
    const Geometry geometry({share({})}, {{0, 0, {}}});
    SurfaceHit hit;
    EXPECT_FALSE(geometry.intersect({}, {0, 0, 1}, infinity, nullptr, hit));
    EXPECT_TRUE(geometry.enclosing({}, {true}).empty());
    EXPECT_TRUE(geometry.bounds().empty());
    const Geometry sphere({UnitSphere{}}, {{0, 0, {}}});
    EXPECT_FALSE(sphere.intersect({}, {0, 0, 0}, infinity, nullptr, hit));
    EXPECT_FALSE(sphere.intersect({std::nan(""), 0, 0}, {0, 0, 1}, infinity, nullptr, hit));
    EXPECT_FALSE(sphere.intersect({}, {0, 0, 1}, 0, nullptr, hit));
}

TEST(Geometry, AMillionInstancesFit) {
    const auto box = share(boxMesh({{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}}));
    std::vector<ShapeInstance> instances;
    constexpr int side = 100;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z)
                instances.push_back({0, 0, Affine3d::translate(Vec3i{x, y, z}.as<double>())});
    const Geometry geometry({box}, std::move(instances));
    const double bytes = static_cast<double>(geometry.memoryBytes()) / 1e6;
    RecordProperty("bytesPerInstance", static_cast<int>(bytes));
    EXPECT_LT(bytes, 400);
    SurfaceHit hit;
    ASSERT_TRUE(geometry.intersect({-3, 57, 31}, {1, 0, 0}, infinity, nullptr, hit));
    EXPECT_EQ(hit.instance, 5731u);
    EXPECT_NEAR(hit.t, 2.6, 1e-7);
    EXPECT_FALSE(geometry.intersect({-3, 57.5, 31.5}, {1, 0, 0}, infinity, nullptr, hit));
    EXPECT_EQ(geometry.enclosing({12, 34, 56}, {true}), (std::vector<std::uint32_t>{123456}));
}

}  // namespace
}  // namespace woodcock::test
