// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/damage_vdb.h"
#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"
#include "woodcock/grid/vdb/read_grids.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

std::vector<std::string> readableNames(const VdbFile& file) {
    std::vector<std::string> names;
    for (const GridListing& grid : file.grids)
        if (isReadable(grid)) names.push_back(grid.uniqueName);
    return names;
}

template <class GridT>
bool sameTree(const openvdb::GridBase& a, const openvdb::GridBase& b) {
    if (!a.isType<GridT>()) return false;
    const auto& x = static_cast<const GridT&>(a).tree();
    const auto& y = static_cast<const GridT&>(b).tree();
    EXPECT_EQ(x.background(), y.background());
    EXPECT_TRUE(x.hasSameTopology(y)) << a.getName();
    openvdb::tree::ValueAccessor<const typename GridT::TreeType> access(y);
    for (auto it = x.cbeginValueAll(); it; ++it) {
        EXPECT_EQ(*it, access.getValue(it.getCoord())) << a.getName();
        EXPECT_EQ(it.isValueOn(), access.isValueOn(it.getCoord())) << a.getName();
    }
    return true;
}

/// OpenVDB's own reader is the truth for healthy files.
TEST(VdbGridsRead, GivesWhatOpenVdbGives) {
    const TempDir dir;
    std::size_t compared = 0;
    for (const VdbSample& sample : healthyVdbs()) {
        writeText(dir / "a.vdb", sample.bytes);
        const VdbFile listed = listGrids(dir / "a.vdb");
        if (listed.version.empty()) continue;
        const std::vector<std::string> names = readableNames(listed);
        const VdbGrids read = readVdbGrids(listed, names);
        if (sample.name.find("stream") != std::string::npos) continue;  // no io::File reads it
        if (sample.name == "native half") continue;                     // but since OpenVDB 13
        openvdb::io::File file((dir / "a.vdb").string());
        file.open(false);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const openvdb::GridBase::Ptr truth = file.readGrid(names[i]);
            const openvdb::GridBase& grid = *read.grids[i];
            ASSERT_EQ(grid.type(), truth->type());
            EXPECT_EQ(grid.transform(), truth->transform());
            EXPECT_EQ(grid.getName(), truth->getName());
            EXPECT_EQ(grid.getGridClass(), truth->getGridClass());
            using namespace openvdb;
            compared += sameTree<FloatGrid>(grid, *truth) || sameTree<DoubleGrid>(grid, *truth) ||
                        sameTree<Int32Grid>(grid, *truth) || sameTree<Int64Grid>(grid, *truth) ||
                        sameTree<BoolGrid>(grid, *truth) || sameTree<Vec3SGrid>(grid, *truth) ||
                        sameTree<Vec3DGrid>(grid, *truth) || sameTree<Vec3IGrid>(grid, *truth);
        }
    }
    EXPECT_GT(compared, 10u);
}

/// Every half is a float, so nothing is lost.
TEST(VdbGridsRead, NativeHalvesBecomeFloatsToBeSavedAsHalf) {
    GridSpec spec{.name = "smoke",
                  .type = VdbType::Half,
                  .background = {0.25},
                  .tiles = {{{128, 0, 0}, 128, {3}, false}, {{-8, 0, 0}, 8, {2}}},
                  .box = {{0, 0, 0}, {20, 9, 11}},
                  .worldFromIndex = Affine3d::scale({0.5, 0.5, 0.5}),
                  .metadata = {{"author", "somebody"}}};
    spec.value = [](Vec3i v) { return v.x * 0.5 + v.y * 64 - v.z; };
    spec.voxels = {{{40, 0, 0}, {65504}}, {{41, 0, 0}, {0x1p-24}, false}};
    GridSpec floats = spec;
    floats.type = VdbType::Float;
    const TempDir dir;
    writeVdb(dir / "float.vdb", {floats});
    const VdbGrids truth = readVdbGrids(listGrids(dir / "float.vdb"), {"smoke"});
    for (const VdbCompression compression :
         {VdbCompression::None, VdbCompression::Zip, VdbCompression::Blosc}) {
        writeVdb(dir / "half.vdb", {spec}, compression);
        const VdbFile listed = listGrids(dir / "half.vdb");
        EXPECT_EQ(describeGrids(listed), "smoke (half)");
        const VdbGrids read = readVdbGrids(listed, {"smoke"});
        const openvdb::GridBase& grid = *read.grids.at(0);
        EXPECT_TRUE(sameTree<openvdb::FloatGrid>(grid, *truth.grids.at(0)));
        EXPECT_EQ(grid.transform(), truth.grids[0]->transform());
        EXPECT_EQ(grid.getName(), "smoke");
        EXPECT_EQ(grid.metaValue<std::string>("author"), "somebody");
        EXPECT_TRUE(grid.saveFloatAsHalf());
    }
}

TEST(VdbGridsRead, LevelSetsAreReadThoughTheyCannotBeRendered) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {{.name = "surface",
                              .background = {3},
                              .voxels = {{{1, 2, 3}, {-0.5}}},
                              .gridClass = "level set"}});
    const VdbGrids read = readVdbGrids(listGrids(dir / "a.vdb"), {"surface"});
    ASSERT_EQ(read.grids.size(), 1u);
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(read.grids[0]);
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_EQ(grid->tree().getValue({1, 2, 3}), -0.5f);
    EXPECT_EQ(grid->background(), 3);
}

TEST(VdbGridsRead, WhatCannotBeReadIsNamed) {
    const TempDir dir;
    writeVdb(dir / "a.vdb",
             {{.name = "cone", .frustum = true}, {.name = "cloud", .type = VdbType::Points}});
    const VdbFile file = listGrids(dir / "a.vdb");
    expectError(ErrorKind::Input, "frustum", [&] { readVdbGrids(file, {"cone"}); });
    expectError(ErrorKind::Input, "points", [&] { readVdbGrids(file, {"cloud"}); });
    expectError(ErrorKind::Input, "it has: cone (float), cloud (points)",
                [&] { readVdbGrids(file, {"density"}); });
}

TEST(VdbGridsRead, DamagedFilesAreGridsOrErrors) {
    const TempDir dir;
    const std::vector<VdbSample> samples = healthyVdbs();
    int errors = 0, files = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        writeText(dir / "a.vdb", damagedVdb(samples[seed % samples.size()], seed));
        try {
            const VdbFile listed = listGrids(dir / "a.vdb");
            readVdbGrids(listed, readableNames(listed));
            ++files;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input) << e.what();
            ++errors;
        }
    }
    EXPECT_GT(errors, 100);
    EXPECT_GT(files, 50);
}

}  // namespace
}  // namespace woodcock::test
