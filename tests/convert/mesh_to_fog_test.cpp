// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/box_shapes.h"
#include "tests/support/expect_error.h"
#include "woodcock/convert/mesh_to_fog.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace convert;
using namespace grid;
using namespace mesh;

namespace {

TriangleMesh cube() { return cubeOf(1); }

/// Inside and outside, edges and corners too.
double distanceToCube(Vec3d p) {
    const Vec3d q{std::abs(p.x) - 1, std::abs(p.y) - 1, std::abs(p.z) - 1};
    return length(max(q, Vec3d{0, 0, 0})) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

const openvdb::FloatGrid& only(const VdbGrids& grids) {
    EXPECT_EQ(grids.grids.size(), 1u);
    return static_cast<const openvdb::FloatGrid&>(*grids.grids.at(0));
}

/// Off the lattice, so that no voxel lies on the surface.
constexpr double voxel = 0.0437;

template <class Check>
void forVoxelsAround(const openvdb::FloatGrid& grid, const Check& check) {
    const auto access = grid.getConstAccessor();
    for (int x = -32; x <= 32; ++x)
        for (int y = -32; y <= 32; ++y)
            for (int z = -32; z <= 32; ++z)
                check(Vec3d{x * voxel, y * voxel, z * voxel}, access.getValue({x, y, z}));
}

double mass(const openvdb::FloatGrid& grid) {
    double sum = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it)
        sum += static_cast<double>(*it) * static_cast<double>(it.getVoxelCount());
    return sum * voxel * voxel * voxel;
}

TEST(MeshToFog, ALevelSetIsTheDistanceAndFogItsRamp) {
    std::vector<std::string> notes;
    const double band = 0.3;
    const VdbGrids levelSet = meshToLevelSet(cube(), {.voxel = voxel, .band = band}, notes);
    forVoxelsAround(only(levelSet), [&](Vec3d p, float v) {
        const double d = distanceToCube(p);
        if (std::abs(d) <= band)
            EXPECT_NEAR(v, d, 1e-5);
        else
            EXPECT_TRUE(d < 0 ? v <= -band : v >= band) << v << " where " << d;
    });
    const VdbGrids fog = meshToFog(cube(), {.voxel = voxel, .band = band}, notes);
    forVoxelsAround(only(fog), [&](Vec3d p, float v) {
        EXPECT_NEAR(v, std::clamp(-distanceToCube(p) / band, 0.0, 1.0), 1e-4);
    });
    EXPECT_TRUE(notes.empty());
}

/// The integral of the ramp over a cube: of min(depth, band) / band.
TEST(MeshToFog, MassIsThatOfTheRampWhicheverWayTrianglesFace) {
    const double band = 0.3, inner = 1 - band;
    // Between the cubes of half sides h and h + dh lie 24 h^2 dh, at depth 1 - h.
    const double ramp = (8 * (1 - std::pow(inner, 3)) - 6 * (1 - std::pow(inner, 4))) / band;
    const double expected = 8 * std::pow(inner, 3) + ramp;
    TriangleMesh turned = cube();
    for (auto& [a, b, c] : turned.triangles) std::swap(b, c);
    std::vector<std::string> notes;
    for (const TriangleMesh& mesh : {cube(), turned}) {
        const VdbGrids fog = meshToFog(mesh, {.voxel = voxel, .band = band}, notes);
        EXPECT_NEAR(mass(only(fog)), expected, 0.002 * expected);
        EXPECT_GT(only(fog).tree().activeTileCount(), 0u);
    }
}

TEST(MeshToFog, AnOpenMeshIsReportedAndHasAShell) {
    TriangleMesh square = cube();
    square.triangles.resize(2);
    std::vector<std::string> notes;
    expectError(ErrorKind::Input, "the mesh is open: 4 edges",
                [&] { meshToFog(square, {.voxel = voxel}, notes); });
    const double band = 0.2;
    const VdbGrids shell = meshToFog(square, {.voxel = voxel, .band = band, .shell = true}, notes);
    forVoxelsAround(only(shell), [&](Vec3d p, float v) {
        const Vec3d q{p.x + 1, std::abs(p.y) - 1, std::abs(p.z) - 1};
        const double d = length({q.x, std::max(q.y, 0.0), std::max(q.z, 0.0)});
        EXPECT_NEAR(v, std::max(1 - d / band, 0.0), 1e-4);
    });
    TriangleMesh lidless = cube();
    lidless.triangles.erase(lidless.triangles.begin() + 2, lidless.triangles.begin() + 4);
    for (const char* said : {"4 edges", "--shell"})
        expectError(ErrorKind::Input, said, [&] { meshToFog(lidless, {.voxel = voxel}, notes); });
    expectError(ErrorKind::Input, "4 edges",
                [&] { meshToLevelSet(lidless, {.voxel = voxel}, notes); });
    EXPECT_TRUE(notes.empty());
}

float at(const VdbGrids& grids, Vec3d place) {
    const openvdb::FloatGrid& grid = only(grids);
    const openvdb::Vec3d p =
        grid.transform().worldToIndex(openvdb::Vec3d(place.x, place.y, place.z));
    return grid.tree().getValue(openvdb::Coord::round(p));
}

/// Cubes about the origin, one in the other: every second space between them is solid.
void expectShells(const TriangleMesh& mesh, const std::vector<double>& halfSides) {
    std::vector<std::string> notes;
    const double band = 0.1;
    const VdbGrids fog = meshToFog(mesh, {.voxel = voxel, .band = band}, notes);
    EXPECT_TRUE(notes.empty()) << notes.front();
    const auto distanceTo = [](Vec3d p, double half) {
        const Vec3d q{std::abs(p.x) - half, std::abs(p.y) - half, std::abs(p.z) - half};
        return length(max(q, Vec3d{0, 0, 0})) + std::min(std::max({q.x, q.y, q.z}), 0.0);
    };
    forVoxelsAround(only(fog), [&](Vec3d p, float v) {
        double nearest = 100;
        std::size_t around = 0;
        for (const double half : halfSides) {
            const double d = distanceTo(p, half);
            nearest = std::min(nearest, std::abs(d));
            around += d < 0;
        }
        EXPECT_NEAR(v, around % 2 == 1 ? std::min(nearest / band, 1.0) : 0.0, 1e-4)
            << p.x << " " << p.y << " " << p.z;
    });
}

TEST(MeshToFog, CavitiesStayEmptyHoweverDeepTheyNest) {
    const Facing out = Facing::Outwards, in = Facing::Inwards;
    expectShells(together({cubeOf(1.2), cubeOf(0.7, in)}), {1.2, 0.7});
    expectShells(together({cubeOf(0.7, in), cubeOf(1.2)}), {1.2, 0.7});
    // All of it inside out.
    expectShells(together({cubeOf(1.2, in), cubeOf(0.7, out)}), {1.2, 0.7});
    // A ball in the cavity, whichever way it faces: in what is empty there is no cavity.
    expectShells(together({cubeOf(1.2), cubeOf(0.9, in), cubeOf(0.5, out)}), {1.2, 0.9, 0.5});
    expectShells(together({cubeOf(1.2), cubeOf(0.9, in), cubeOf(0.5, in)}), {1.2, 0.9, 0.5});
    expectShells(together({cubeOf(1.3), cubeOf(1.0, in), cubeOf(0.7), cubeOf(0.4, in)}),
                 {1.3, 1.0, 0.7, 0.4});
}

TEST(MeshToFog, APartThatFacesLikeTheOneAroundItIsSolidAndSaid) {
    std::vector<std::string> notes;
    const VdbGrids fog =
        meshToFog(together({cubeOf(1.2), cubeOf(0.7)}), {.voxel = voxel, .band = 0.2}, notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("1 closed part of the mesh within others faces the same way"),
              std::string::npos)
        << notes[0];
    // As if it were not there, its surface too.
    EXPECT_EQ(at(fog, {0, 0, 0}), 1);
    EXPECT_EQ(at(fog, {0.7, 0, 0}), 1);
    EXPECT_NEAR(mass(only(fog)),
                mass(only(meshToFog(cubeOf(1.2), {.voxel = voxel, .band = 0.2}, notes))), 1e-4);
}

double distanceToRectangle(Vec3d p, Vec3d lower, Vec3d upper) {
    return length(max(max(lower - p, p - upper), Vec3d{0, 0, 0}));
}

/// A bar of half width b that stands out of the cube's side x = 1: the surface is that of both
/// without what lies within.
TEST(MeshToFog, PartsThatOverlapAreAUnion) {
    const double b = 0.4, tip = 1.35, band = 0.5;
    const TriangleMesh bar = boxOf({{0.2, -b, -b}, {tip, b, b}});
    TriangleMesh turned = boxOf({{0.2, -b, -b}, {tip, b, b}}, Facing::Inwards);
    for (const TriangleMesh& other : {bar, turned}) {
        std::vector<std::string> notes;
        const VdbGrids fog =
            meshToFog(together({cube(), other}), {.voxel = voxel, .band = band}, notes);
        EXPECT_TRUE(notes.empty());
        double worst = 0;
        forVoxelsAround(only(fog), [&](Vec3d p, float v) {
            const bool inCube = distanceToCube(p) < 0;
            const bool inBar = p.x > 0.2 && p.x < tip && std::abs(p.y) < b && std::abs(p.z) < b;
            double depth = 0;
            if (inCube || inBar) {
                depth = distanceToRectangle(p, {-1, -1, -1}, {-1, 1, 1});
                for (const double s : {-1.0, 1.0}) {
                    const auto add = [&](Vec3d lower, Vec3d upper) {
                        depth = std::min(depth, distanceToRectangle(p, lower, upper));
                    };
                    add({-1, s, -1}, {1, s, 1});
                    add({-1, -1, s}, {1, 1, s});
                    add({1, std::min(s, s * b), -1}, {1, std::max(s, s * b), 1});
                    add({1, -1, std::min(s, s * b)}, {1, 1, std::max(s, s * b)});
                    add({1, s * b, -b}, {tip, s * b, b});
                    add({1, -b, s * b}, {tip, b, s * b});
                }
                depth = std::min(depth, distanceToRectangle(p, {tip, -b, -b}, {tip, b, b}));
            }
            worst = std::max(worst,
                             std::abs(static_cast<double>(v) - std::clamp(depth / band, 0.0, 1.0)));
        });
        // Where one surface ends on the other it is cut to an eighth of a voxel.
        EXPECT_LT(worst, voxel / 8 / band);
    }
}

TEST(MeshToFog, CavitiesThatOverlapAreOneAndTouchingCubesTouch) {
    std::vector<std::string> notes;
    const VdbGrids fog = meshToFog(together({cubeOf(1.3), cubeOf(0.5, Facing::Inwards, {0.3, 0, 0}),
                                             cubeOf(0.5, Facing::Inwards, {-0.3, 0.1, 0})}),
                                   {.voxel = voxel, .band = 0.1}, notes);
    for (const double x : {-0.7, -0.3, 0.0, 0.3, 0.7}) EXPECT_EQ(at(fog, {x, 0, 0}), 0) << x;
    EXPECT_EQ(at(fog, {1.05, 0, 0}), 1);
    // Of different triangles, so that the sides between them are not one.
    const VdbGrids touching = meshToFog(
        together({boxOf({{-1, -1, -1}, {0, 1, 1}}), boxOf({{0, -0.6, -0.7}, {1, 0.6, 0.7}})}),
        {.voxel = 0.05, .band = 0.1}, notes);
    for (int x = -10; x <= 10; ++x) EXPECT_EQ(at(touching, {x * 0.05, 0, 0}), 1) << x;
    EXPECT_TRUE(notes.empty());
}

TEST(MeshToFog, TheBandIsAsDeepAsItSays) {
    std::vector<std::string> notes;
    const VdbGrids one = meshToFog(cube(), {.voxel = 0.1, .band = 4}, notes);
    EXPECT_NEAR(at(one, {0, 0, 0}), 0.25, 1e-6);
    EXPECT_NEAR(at(one, {0, 0, 0.6}), 0.1, 1e-6);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("the density is 0.25 at most"), std::string::npos) << notes[0];
    const VdbGrids two = meshToFog(together({cube(), cubeOf(3, Facing::Outwards, {10, 0, 0})}),
                                   {.voxel = 0.1, .band = 4}, notes);
    EXPECT_NEAR(at(two, {0, 0, 0}), 0.25, 1e-6);
    EXPECT_NEAR(at(two, {10, 0, 0}), 0.75, 1e-6);
}

TEST(MeshToFog, PlatesThinnerThanVoxelsAreSaid) {
    // Half a voxel thick, about a layer of voxels: their depth is a quarter of a voxel.
    const TriangleMesh plate = boxOf({{-1, -1, -0.025}, {1, 1, 0.025}});
    std::vector<std::string> notes;
    const VdbGrids fog = meshToFog(plate, {.voxel = 0.1}, notes);
    EXPECT_NEAR(at(fog, {0, 0, 0}), 0.025 / 0.3, 1e-6);
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_NE(notes[0].find("about as thin as a voxel"), std::string::npos) << notes[0];
    EXPECT_NE(notes[1].find("the density is 0.0833 at most"), std::string::npos) << notes[1];
    // Beside a cube, and between two layers: nothing is left of it.
    notes.clear();
    meshToFog(together({cubeOf(0.5, Facing::Outwards, {0, 0, 3}),
                        boxOf({{-1, -1, 0.025}, {1, 1, 0.075}})}),
              {.voxel = 0.1}, notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("thinner than a voxel over 8"), std::string::npos) << notes[0];
}

/// A map's coordinates: what floats would make of them is layers half a metre apart.
TEST(MeshToFog, FarFromTheOriginItIsTheSameMoved) {
    const Vec3d far = Vec3d{11723000, -123850000, 91500} * voxel;
    TriangleMesh moved = cube();
    moved.origin = far;
    std::vector<std::string> notes;
    const VdbGrids here = meshToFog(cube(), {.voxel = voxel, .band = 0.3}, notes);
    const VdbGrids there = meshToFog(moved, {.voxel = voxel, .band = 0.3}, notes);
    EXPECT_EQ(only(there).activeVoxelCount(), only(here).activeVoxelCount());
    for (auto it = only(here).cbeginValueOn(); it; ++it) {
        if (!it.isVoxelValue()) continue;
        const openvdb::Vec3d p = only(here).indexToWorld(it.getCoord());
        ASSERT_NEAR(at(there, Vec3d{p[0], p[1], p[2]} + far), *it, 1e-5);
    }
    const openvdb::CoordBBox box = only(there).evalActiveVoxelBoundingBox();
    for (int a = 0; a < 3; ++a) EXPECT_LT(std::abs(box.min()[a]), 30);
}

TEST(MeshToFog, TooManyVoxelsAreRefusedBeforeTheyAreMade) {
    std::vector<std::string> notes;
    expectError(ErrorKind::Input, "take voxels of at least",
                [&] { meshToFog(cube(), {.voxel = 1e-5}, notes); });
    expectError(ErrorKind::Input, "beyond the largest index",
                [&] { meshToFog(cube(), {.voxel = 1e-12}, notes); });
    expectError(ErrorKind::Usage, "voxel size of 0", [&] { meshToFog(cube(), {}, notes); });
    TriangleMesh between = cube();  // no voxel's centre lies in it
    for (Vec3f& p : between.points) p += {50, 50, 50};
    expectError(ErrorKind::Input, "thinner than its voxels",
                [&] { meshToFog(between, {.voxel = 100}, notes); });
}

}  // namespace
}  // namespace woodcock::test
