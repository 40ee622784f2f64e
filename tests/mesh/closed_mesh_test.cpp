// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/closed_mesh.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/box_shapes.h"
#include "tests/support/expect_error.h"

namespace woodcock::test {

using namespace mesh;

namespace {

double total(const ClosedMesh& mesh) {
    return std::accumulate(mesh.volumes.begin(), mesh.volumes.end(), 0.0);
}

void expectNote(const ClosedMesh& mesh, const std::string& part) {
    ASSERT_EQ(mesh.notes.size(), 1u);
    EXPECT_NE(mesh.notes[0].find(part), std::string::npos) << mesh.notes[0];
}

TEST(ClosedMesh, PartsHaveTheirVolumesAndSigns) {
    const ClosedMesh mesh = closedMesh(together(
        {cubeOf(2), cubeOf(1, Facing::Inwards), cubeOf(0.5, Facing::Outwards, {9, 0, 0})}));
    const std::vector<double> expected{64, -8, 1};
    ASSERT_EQ(mesh.volumes.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(mesh.volumes[i], expected[i], 1e-12) << i;
    EXPECT_EQ(mesh.partOf.size(), 36u);
    EXPECT_EQ(mesh.partOf[0], 0u);
    EXPECT_EQ(mesh.partOf[12], 1u);
    EXPECT_EQ(mesh.partOf[35], 2u);
    EXPECT_TRUE(mesh.notes.empty());
}

TEST(ClosedMesh, OpenOnesAreRefusedWithTheirPlace) {
    TriangleMesh open = cubeOf(1);
    open.triangles.pop_back();
    expectError(ErrorKind::Input, "the mesh is open: 3 edges belong to one triangle only",
                [&] { closedMesh(open); });
    expectError(ErrorKind::Input, "in 1 of its 2 pieces", [&] {
        closedMesh(weld(together({cubeOf(1, Facing::Outwards, {5, 0, 0}), open})));
    });
    TriangleMesh lidless = cubeOf(1);
    lidless.triangles.resize(10);  // without z = 1
    lidless.origin = {512000, 5412000, 0};
    expectError(ErrorKind::Input, "4 edges", [&] { closedMesh(lidless); });
    expectError(ErrorKind::Input, "(first at 512000, 5411999, 1)", [&] { closedMesh(lidless); });
    expectError(ErrorKind::Input, "no triangles", [] { closedMesh({}); });
    expectError(ErrorKind::Input, "all of its triangles have zero area", [] {
        closedMesh({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{{0, 1, 2}}}});
    });
}

TEST(ClosedMesh, AWallWithinDividesNoSpace) {
    TriangleMesh walled = cubeOf(1);  // with a wall from edge to edge
    walled.triangles.push_back({0, 3, 7});
    walled.triangles.push_back({0, 7, 4});
    expectError(ErrorKind::Input, "4 edges belong to an odd number of triangles",
                [&] { closedMesh(walled); });
}

TEST(ClosedMesh, TrianglesThatFaceTheWrongWayAreTurned) {
    for (const Facing facing : {Facing::Outwards, Facing::Inwards}) {
        TriangleMesh mesh = cubeOf(1, facing);
        std::swap(mesh.triangles[4][1], mesh.triangles[4][2]);
        std::swap(mesh.triangles[9][1], mesh.triangles[9][2]);
        const ClosedMesh closed = closedMesh(mesh);
        EXPECT_EQ(closed.volumes, std::vector<double>{facing == Facing::Outwards ? 8.0 : -8.0});
        expectNote(closed,
                   "2 triangles faced the other way than their neighbours, and were flipped");
    }
}

TEST(ClosedMesh, CoincidentTrianglesAreOne) {
    TriangleMesh twice = cubeOf(1);
    twice.triangles.push_back(twice.triangles[3]);
    expectNote(closedMesh(twice), "1 triangle of the mesh coincides with others");
    EXPECT_EQ(total(closedMesh(twice)), 8);
    // Drawn from both sides: each triangle is there in both ways.
    const ClosedMesh both = closedMesh(weld(together({cubeOf(1), cubeOf(1, Facing::Inwards)})));
    EXPECT_EQ(both.mesh.triangles.size(), 12u);
    EXPECT_EQ(std::abs(total(both)), 8);
    // Two boxes side by side: the wall between them has no thickness.
    const ClosedMesh glued = closedMesh(weld(together(
        {boxOf({{0, 0, 0}, {1, 1, 1}}), boxOf({{1, 0, 0}, {2, 1, 1}}, Facing::Outwards)})));
    EXPECT_EQ(glued.volumes.size(), 1u);
    EXPECT_NEAR(total(glued), 2, 1e-12);
}

TEST(ClosedMesh, CubesThatShareAnEdgeAreClosed) {
    const ClosedMesh mesh =
        closedMesh(weld(together({boxOf({{0, 0, 0}, {1, 1, 1}}), boxOf({{1, 1, 0}, {2, 2, 1}})})));
    EXPECT_NEAR(total(mesh), 2, 1e-12);
    EXPECT_TRUE(mesh.notes.empty());
}

TEST(ClosedMesh, GapsOfRoundingAreClosed) {
    TriangleMesh mesh = cubeOf(1);
    mesh.points.push_back({std::nextafter(-1.0f, 0.0f), -1, std::nextafter(-1.0f, -2.0f)});
    for (std::uint32_t& i : mesh.triangles[0]) i = i == 0 ? 8 : i;
    expectNote(closedMesh(mesh), "1 point at open edges");
    EXPECT_NEAR(total(closedMesh(mesh)), 8, 1e-5);
    mesh.points[8].x = -0.99f;
    expectError(ErrorKind::Input, "the mesh is open", [&] { closedMesh(mesh); });
}

/// A grid whose left and right side are one, as are its lower and upper side, turned over.
TEST(ClosedMesh, AKleinBottleHasNoInside) {
    constexpr std::uint32_t n = 6;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n * n; ++i)
        mesh.points.push_back(
            {static_cast<float>(i % n), static_cast<float>(i / n), static_cast<float>(i * i % 7)});
    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        if (y == n) x = (2 * n - x) % n;
        return x % n + n * (y % n);
    };
    for (std::uint32_t x = 0; x < n; ++x)
        for (std::uint32_t y = 0; y < n; ++y) {
            mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    expectError(ErrorKind::Input, "cannot all face one way", [&] { closedMesh(mesh); });
}

}  // namespace
}  // namespace woodcock::test
