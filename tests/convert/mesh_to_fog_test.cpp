// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>

#include "tests/support/expect_error.h"
#include "woodcock/convert/mesh_to_fog.h"
#include "woodcock/grid/openvdb_grids.h"

namespace woodcock::test {
namespace {

/// [-1, 1]^3
TriangleMesh cube() {
    return {{{-1, -1, -1},
             {1, -1, -1},
             {1, 1, -1},
             {-1, 1, -1},
             {-1, -1, 1},
             {1, -1, 1},
             {1, 1, 1},
             {-1, 1, 1}},
            {{{0, 2, 1}},
             {{0, 3, 2}},
             {{4, 5, 6}},
             {{4, 6, 7}},
             {{0, 1, 5}},
             {{0, 5, 4}},
             {{1, 2, 6}},
             {{1, 6, 5}},
             {{2, 3, 7}},
             {{2, 7, 6}},
             {{3, 0, 4}},
             {{3, 4, 7}}}};
}

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
        const Vec3d q{std::abs(p.x) - 1, std::abs(p.y) - 1, p.z + 1};
        const double d = length({std::max(q.x, 0.0), std::max(q.y, 0.0), q.z});
        EXPECT_NEAR(v, std::max(1 - d / band, 0.0), 1e-4);
    });
    TriangleMesh lidless = cube();
    lidless.triangles.erase(lidless.triangles.begin() + 2, lidless.triangles.begin() + 4);
    meshToLevelSet(lidless, {.voxel = voxel}, notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("4 edges"), std::string::npos) << notes[0];
}

TEST(MeshToFog, TooManyVoxelsAreRefusedBeforeTheyAreMade) {
    std::vector<std::string> notes;
    expectError(ErrorKind::Input, "take voxels of at least",
                [&] { meshToFog(cube(), {.voxel = 1e-5}, notes); });
    expectError(ErrorKind::Input, "indices end at",
                [&] { meshToFog(cube(), {.voxel = 1e-12}, notes); });
    expectError(ErrorKind::Usage, "voxel size of 0", [&] { meshToFog(cube(), {}, notes); });
    TriangleMesh between = cube();  // no voxel's centre lies in it
    for (Vec3f& p : between.points) p += {50, 50, 50};
    expectError(ErrorKind::Input, "thinner than its voxels",
                [&] { meshToFog(between, {.voxel = 100}, notes); });
}

}  // namespace
}  // namespace woodcock::test
