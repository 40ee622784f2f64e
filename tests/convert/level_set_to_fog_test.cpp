// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <limits>

#include "tests/support/expect_error.h"
#include "woodcock/convert/level_set_to_fog.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace convert;
using namespace grid;

namespace {

constexpr float radius = 2, voxel = 0.1f;

VdbGrids sphere() {
    const auto grid =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(radius, {0, 0, 0}, voxel, 5);
    grid->setName("ball");
    return {{grid}};
}

TEST(LevelSetToFog, IsTheRampOfTheDistance) {
    for (const double band : {0.0, 0.3, 9.0}) {
        std::vector<std::string> notes;
        const VdbGrids fog = levelSetToFog(sphere(), {.band = band}, notes);
        const auto& grid = static_cast<const openvdb::FloatGrid&>(*fog.grids.at(0));
        EXPECT_EQ(grid.getGridClass(), openvdb::GRID_FOG_VOLUME);
        EXPECT_EQ(grid.background(), 0);
        EXPECT_EQ(grid.getName(), "density");
        EXPECT_EQ(notes.size(), band > 0.5 ? 1u : 0u);
        const double full = band == 0.3 ? 0.3 : 0.5;
        for (int x = -24; x <= 24; ++x)
            for (int y = -24; y <= 24; ++y)
                for (int z = -24; z <= 24; ++z) {
                    const double depth = 2 - 0.1 * std::sqrt(x * x + y * y + z * z);
                    EXPECT_NEAR(grid.tree().getValue({x, y, z}), std::clamp(depth / full, 0.0, 1.0),
                                1e-5);
                }
    }
}

TEST(LevelSetToFog, RefusesWhatIsNone) {
    std::vector<std::string> notes;
    VdbGrids fog = sphere();
    fog.grids[0]->setGridClass(openvdb::GRID_FOG_VOLUME);
    expectError(ErrorKind::Input, "grid 'ball' is not a level set: its class is 'fog volume'",
                [&] { levelSetToFog(fog, {}, notes); });
    VdbGrids faulty = sphere();
    static_cast<openvdb::FloatGrid&>(*faulty.grids[0])
        .tree()
        .setValue({20, 0, 0}, std::numeric_limits<float>::quiet_NaN());
    expectError(ErrorKind::Input, "NaN at [20, 0, 0]", [&] { levelSetToFog(faulty, {}, notes); });
    VdbGrids empty{{openvdb::FloatGrid::create(1.0f)}};
    empty.grids[0]->setGridClass(openvdb::GRID_LEVEL_SET);
    expectError(ErrorKind::Input, "encloses nothing", [&] { levelSetToFog(empty, {}, notes); });
}

}  // namespace
}  // namespace woodcock::test
