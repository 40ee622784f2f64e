// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/faceted_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_error.h"
#include "tests/support/mesh_volume.h"

namespace woodcock::test {

using namespace mesh;

namespace {

double areaOf(const TriangleMesh& m) {
    double area = 0;
    for (const auto& t : m.triangles) {
        const Vec3d a = m.points[t[0]].as<double>();
        area += length(cross(m.points[t[1]].as<double>() - a, m.points[t[2]].as<double>() - a)) / 2;
    }
    return area;
}

/// Of 6000 facets, most of which no plane comes near.
TEST(FacetedMesh, ManyFacetsMakeABall) {
    std::vector<FacetRing> rings;
    for (int i = 0; i <= 100; ++i) rings.push_back({1.8 * i, 60, 1, 3.0 * (i % 2)});
    const SurfaceMesh ball = facetedMesh(rings);
    EXPECT_TRUE(checkClosed(ball.mesh).closed);
    EXPECT_NEAR(volume(ball.mesh), 4 * pi / 3, 0.005);
    EXPECT_GT(volume(ball.mesh), 4 * pi / 3);
    EXPECT_GT(ball.mesh.triangles.size(), 10000U);
}

TEST(FacetedMesh, TooManyAreRefused) {
    const std::vector<FacetRing> rings(26, {90, 1000, 1, 0});
    expectError(ErrorKind::Usage, "more than 25000 facets; a mesh from a file may have more",
                [&] { facetedMesh(rings); });
}

TEST(FacetedMesh, CubeOctahedronAndPrism) {
    const SurfaceMesh cube =
        facetedMesh(std::vector<FacetRing>{{0, 1, 1, 0}, {180, 1, 1, 0}, {90, 4, 1, 0}});
    EXPECT_NEAR(volume(cube.mesh), 8, 1e-5);
    EXPECT_EQ(cube.mesh.triangles.size(), 12U);
    EXPECT_EQ(cube.mesh.points.size(), 8U);

    const double diagonal = std::acos(1 / std::sqrt(3.0)) * 180 / pi;
    const SurfaceMesh octahedron =
        facetedMesh(std::vector<FacetRing>{{diagonal, 4, 1, 45}, {180 - diagonal, 4, 1, 45}});
    // All facets at distance 1 from the centre: V = A / 3.
    EXPECT_NEAR(volume(octahedron.mesh), 4 * std::sqrt(3.0), 1e-5);
    EXPECT_EQ(octahedron.mesh.points.size(), 6U);
    EXPECT_EQ(octahedron.mesh.triangles.size(), 8U);

    const SurfaceMesh prism =
        facetedMesh(std::vector<FacetRing>{{0, 1, 2, 0}, {180, 1, 2, 0}, {90, 16, 1, 10}});
    EXPECT_NEAR(volume(prism.mesh), 4 * 16 * std::tan(pi / 16), 1e-4);
}

/// A brilliant: all facets of one kind touch a sphere, others cut it; whatever the cut, the mesh is
/// closed and has Euler's characteristic, and an inscribed body has V = A r / 3.
TEST(FacetedMesh, BrilliantIsClosed) {
    const std::vector<FacetRing> brilliant{
        {0, 1, 0.35, 0}, {34.5, 8, 0.62, 0},    {41, 16, 0.7, 11.25},         {22, 8, 0.5, 22.5},
        {90, 32, 1, 0},  {180 - 41, 8, 0.7, 0}, {180 - 42.5, 16, 0.72, 11.25}};
    const SurfaceMesh gem = facetedMesh(brilliant);
    EXPECT_EQ(findOpenEdges(gem.mesh).count, 0U);
    const auto v = gem.mesh.points.size(), f = gem.mesh.triangles.size();
    EXPECT_EQ(v + f - f * 3 / 2, 2U);
    EXPECT_GT(volume(gem.mesh), 0);

    std::vector<FacetRing> round = brilliant;
    for (FacetRing& ring : round) ring.distance = 1;
    const TriangleMesh ball = facetedMesh(round).mesh;
    EXPECT_NEAR(volume(ball) / areaOf(ball), 1.0 / 3, 1e-6);
}

TEST(FacetedMesh, RefusesWhatIsOpenOrSenseless) {
    expectError(ErrorKind::Usage, "do not enclose a body", [] {
        facetedMesh(std::vector<FacetRing>{{90, 8, 1, 0}});
    });
    expectError(ErrorKind::Usage, "distance of 0", [] {
        facetedMesh(std::vector<FacetRing>{{90, 8, 0, 0}});
    });
    expectError(ErrorKind::Usage, "angle of 181", [] {
        facetedMesh(std::vector<FacetRing>{{181, 8, 1, 0}});
    });
    expectError(ErrorKind::Usage, "ring of 0", [] {
        facetedMesh(std::vector<FacetRing>{{90, 0, 1, 0}});
    });
}

}  // namespace
}  // namespace woodcock::test
