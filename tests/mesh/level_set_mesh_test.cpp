// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/mesh/surface_mesh.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace mesh;
using namespace proof;

namespace {

constexpr double radius = 10, band = 3;  // voxels

GridSpec ball(const Affine3d& worldFromIndex, double voxel) {
    GridSpec grid;
    grid.name = "surface";
    grid.gridClass = "level set";
    grid.background = {band * voxel};
    grid.worldFromIndex = worldFromIndex;
    grid.box = {{-14, -14, -14}, {14, 14, 14}};
    grid.value = [voxel](Vec3i i) {
        return voxel * std::clamp(length(i.as<double>()) - radius, -band, band);
    };
    return grid;
}

struct Case {
    Affine3d worldFromIndex;
    VdbType type = VdbType::Float;
    double adaptivity = 0;
};

TEST(LevelSetMesh, ABallsSurfaceIsClosedFacesOutwardsAndLiesWhereItShould) {
    const double voxel = 0.25;
    const Vec3d centre{3, -4, 5};
    const auto placed = [&](Vec3d scale) {
        return Affine3d::translate(centre) * Affine3d::rotate(0, 30) * Affine3d::scale(scale);
    };
    for (const Case& c : {Case{placed({voxel, voxel, voxel})},
                          Case{placed({voxel, voxel, -voxel}), VdbType::Double},
                          Case{placed({voxel, voxel, voxel}), VdbType::Float, 0.5}}) {
        const TempDir dir;
        GridSpec grid = ball(c.worldFromIndex, voxel);
        grid.type = c.type;
        writeVdb(dir / "a.vdb", {grid, GridSpec{}});
        const SurfaceMesh mesh = levelSetMesh(dir / "a.vdb", "", c.adaptivity);
        const Closedness closed = checkClosed(mesh.mesh);
        EXPECT_TRUE(closed.closed) << closed.problem;
        EXPECT_FALSE(closed.inwards);
        // As many quads as voxel edges cross the ball: 6 pi r^2, two triangles each; fewer where it
        // may adapt.
        const auto triangles = static_cast<double>(mesh.mesh.triangles.size());
        const double all = 12 * pi * radius * radius;
        if (c.adaptivity == 0)
            EXPECT_NEAR(triangles, all, 0.05 * all);
        else
            EXPECT_LT(triangles, 0.3 * all);
        for (const Vec3f& p : mesh.mesh.points)
            ASSERT_NEAR(length(p.as<double>() - centre), radius * voxel,
                        (c.adaptivity == 0 ? 0.1 : 1) * voxel);
    }
}

TEST(LevelSetMesh, WhatIsNoLevelSetIsAnError) {
    const TempDir dir;
    const GridSpec surface = ball({}, 1);
    GridSpec second = surface, whole = surface, nan = surface;
    second.name = "second";
    whole.name = "whole", whole.type = VdbType::Int32;
    nan.name = "nan", nan.voxels = {{{9, 0, 0}, {std::nan("")}}};
    writeVdb(dir / "a.vdb", {GridSpec{}, surface, second, whole, nan});
    writeVdb(dir / "fog.vdb", {GridSpec{}});
    const auto expectBad = [&](const char* file, const char* grid, const char* part) {
        expectError(ErrorKind::Input, part, [&] { levelSetMesh(dir / file, grid, 0); });
        expectError(ErrorKind::Input, file, [&] { levelSetMesh(dir / file, grid, 0); });
    };
    expectBad("a.vdb", "", "several level sets");
    expectBad("a.vdb", "density", "is not a level set: its class is 'fog volume'");
    expectBad("a.vdb", "colour", "no grid 'colour' in");
    expectBad("a.vdb", "whole", "holds int32; expected float or double");
    expectBad("a.vdb", "nan", "holds a NaN at [9, 0, 0]");
    expectBad("fog.vdb", "", "no level set in");
    expectBad("missing.vdb", "", "");
    expectError(ErrorKind::Usage, "an adaptivity of 2",
                [&] { levelSetMesh(dir / "a.vdb", "surface", 2); });
    EXPECT_NO_THROW(levelSetMesh(dir / "a.vdb", "surface", 1));
    GridSpec empty;
    empty.gridClass = "level set";
    empty.background = {3};
    writeVdb(dir / "empty.vdb", {empty});
    expectBad("empty.vdb", "", "has no surface");
}

}  // namespace
}  // namespace woodcock::test
