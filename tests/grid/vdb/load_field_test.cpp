// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/load_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Small integers: exact in every type.
double pattern(Vec3i v) { return 1 + ((v.x * 7 + v.y * 3 + v.z) & 15); }

class VdbLoad : public ::testing::Test {
protected:
    LoadedGrid load(const GridSpec& spec, const LoadOptions& options = {}) {
        writeVdb(file_, {spec});
        return loadGrid(file_, spec.name, options);
    }
    void expectRefused(const GridSpec& spec, const std::string& message,
                       const LoadOptions& options = {}) {
        writeVdb(file_, {spec});
        expectError(ErrorKind::Input, message, [&] { loadGrid(file_, spec.name, options); });
    }
    std::string name() const { return file_.string(); }

    TempDir dir_;
    std::filesystem::path file_ = dir_ / "test.vdb";
};

TEST_F(VdbLoad, EveryScalarTypeKeepsItsValues) {
    for (VdbType type :
         {VdbType::Float, VdbType::Half, VdbType::Double, VdbType::Int32, VdbType::Int64}) {
        GridSpec spec{.type = type, .box = {{-9, -3, 2}, {12, 9, 19}}, .value = pattern};
        const LoadedGrid grid = load(spec);
        ASSERT_EQ(grid.field.channels(), 1);
        for (int x = -10; x <= 13; ++x)
            for (int y = -4; y <= 10; ++y)
                for (int z = 1; z <= 20; ++z) {
                    const bool inside =
                        x >= -9 && x <= 12 && y >= -3 && y <= 9 && z >= 2 && z <= 19;
                    const double expected = inside ? pattern({x, y, z}) : 0.0;
                    ASSERT_EQ(grid.field.voxel({x, y, z}), static_cast<float>(expected))
                        << static_cast<int>(type) << " " << x << " " << y << " " << z;
                }
        EXPECT_EQ(grid.statistics.voxels.active, 22u * 13u * 18u);
    }
}

TEST_F(VdbLoad, BoolAndMaskAreZeroAndOne) {
    for (VdbType type : {VdbType::Bool, VdbType::Mask}) {
        const LoadedGrid grid =
            load({.type = type, .voxels = {{{1, 2, 3}, {1}}, {{-5, 0, 9}, {1}}}});
        EXPECT_EQ(grid.field.voxel({1, 2, 3}), 1);
        EXPECT_EQ(grid.field.voxel({-5, 0, 9}), 1);
        EXPECT_EQ(grid.field.voxel({1, 2, 4}), 0);
        EXPECT_EQ(grid.statistics.voxels.active, 2u);
    }
}

TEST_F(VdbLoad, EveryVectorTypeBecomesThreeChannels) {
    for (VdbType type : {VdbType::Vec3s, VdbType::Vec3d, VdbType::Vec3i}) {
        GridSpec spec{.name = "Cd", .type = type, .box = {{0, 0, 0}, {9, 9, 9}}};
        spec.colour = [](Vec3i v) { return Vec3d{v.x + 1.0, v.y + 20.0, v.z + 300.0}; };
        const LoadedGrid grid = load(spec, {.use = GridUse::Colour});
        ASSERT_EQ(grid.field.channels(), 3);
        for (Vec3i v : {Vec3i{0, 0, 0}, Vec3i{9, 8, 7}, Vec3i{3, 9, 1}}) {
            EXPECT_EQ(grid.field.voxel(v, 0), static_cast<float>(v.x + 1));
            EXPECT_EQ(grid.field.voxel(v, 1), static_cast<float>(v.y + 20));
            EXPECT_EQ(grid.field.voxel(v, 2), static_cast<float>(v.z + 300));
        }
        EXPECT_EQ(grid.field.voxel({10, 0, 0}, 2), 0);
    }
}

TEST_F(VdbLoad, HalfSavedGridsAreStoredAsHalfAndOthersWhereExact) {
    GridSpec spec{.box = {{0, 0, 0}, {15, 7, 7}}};
    spec.value = [](Vec3i v) { return 0.1 * (1 + v.x); };
    EXPECT_EQ(load(spec).field.storage(), Storage::Float);
    EXPECT_EQ(load(spec).field.voxel({3, 0, 0}), 0.4f);
    spec.saveAsHalf = true;
    const LoadedGrid half = load(spec);
    EXPECT_EQ(half.field.storage(), Storage::Half);
    EXPECT_NEAR(half.field.voxel({3, 0, 0}), 0.4, 0.4 * 0x1p-11);
    spec = {.box = {{0, 0, 0}, {15, 7, 7}}, .value = pattern};
    EXPECT_EQ(load(spec).field.storage(), Storage::Half);
    EXPECT_EQ(load(spec, {.storage = Storage::Float}).field.storage(), Storage::Float);
}

TEST_F(VdbLoad, AllCompressionsReadTheSame) {
    for (VdbCompression c : {VdbCompression::None, VdbCompression::Zip, VdbCompression::Blosc}) {
        writeVdb(file_, {{.box = {{0, 0, 0}, {9, 9, 9}}, .value = pattern}}, c);
        EXPECT_EQ(loadGrid(file_, "density").field.voxel({9, 8, 7}), pattern({9, 8, 7}));
    }
}

TEST_F(VdbLoad, TilesOfEveryLevelFillTheirCubes) {
    const LoadedGrid grid = load(
        {.tiles = {{{8, 0, -8}, 8, {2}}, {{128, 0, 0}, 128, {3}}, {{-4096, 0, 4096}, 4096, {4}}},
         .voxels = {{{0, 0, 0}, {1}}}});
    const Field& f = grid.field;
    EXPECT_EQ(f.voxel({8, 0, -8}), 2);
    EXPECT_EQ(f.voxel({15, 7, -1}), 2);
    EXPECT_EQ(f.voxel({16, 7, -1}), 0);
    EXPECT_EQ(f.voxel({128, 0, 0}), 3);
    EXPECT_EQ(f.voxel({255, 127, 127}), 3);
    EXPECT_EQ(f.voxel({256, 0, 0}), 0);
    EXPECT_EQ(f.voxel({-1, 4095, 8191}), 4);
    EXPECT_EQ(f.voxel({-4096, 0, 4096}), 4);
    EXPECT_EQ(f.voxel({-4097, 0, 4096}), 0);
    EXPECT_EQ(grid.statistics.activeTiles, 3u);
    EXPECT_EQ(grid.statistics.voxels.active, 1u + 512u + (1ull << 21) + (1ull << 36));
}

TEST_F(VdbLoad, InactiveValuesAndTheBackgroundCount) {
    const LoadedGrid grid =
        load({.background = {0.25},
              .tiles = {{{16, 0, 0}, 8, {5}, false}, {{24, 0, 0}, 8, {0}, true}},
              .voxels = {{{0, 0, 0}, {1}}, {{1, 0, 0}, {2}, false}, {{2, 0, 0}, {0.25}, true}}});
    const Field& f = grid.field;
    EXPECT_EQ(f.background(), 0.25f);
    EXPECT_EQ(f.voxel({100, 100, 100}), 0.25f);
    EXPECT_EQ(f.voxel({0, 0, 0}), 1);
    EXPECT_EQ(f.voxel({1, 0, 0}), 2);
    EXPECT_EQ(f.voxel({3, 0, 0}), 0.25f);
    EXPECT_EQ(f.voxel({20, 4, 4}), 5);
    EXPECT_EQ(f.voxel({30, 4, 4}), 0);
    EXPECT_EQ(grid.statistics.voxels.inactiveValues, 1u + 512u);
    EXPECT_EQ(grid.statistics.voxels.active, 2u + 512u);
    EXPECT_EQ(grid.statistics.voxels.min[0], 0);
    EXPECT_EQ(grid.statistics.voxels.max[0], 1);
}

TEST_F(VdbLoad, ConstantLeavesNeedNoBrick) {
    GridSpec spec{.box = {{0, 0, 0}, {7, 7, 7}}};
    spec.value = [](Vec3i) { return 3.0; };
    spec.voxels = {{{8, 0, 0}, {0}},
                   {{16, 0, 0}, {1}}};  // an active zero; and one leaf that varies
    const LoadedGrid grid = load(spec);
    EXPECT_EQ(grid.statistics.leaves, 3u);
    EXPECT_EQ(grid.field.brickCount(), 1u);
    EXPECT_EQ(grid.field.voxel({7, 7, 7}), 3);
    EXPECT_EQ(grid.field.voxel({8, 0, 0}), 0);
    EXPECT_EQ(grid.field.voxel({16, 0, 0}), 1);
}

TEST_F(VdbLoad, AnyAffineTransform) {
    const Affine3d sheared{{Vec3d{0.5, 0.1, 0}, Vec3d{0, -0.25, 0.3}, Vec3d{0.2, 0, 2}},
                           {7, -8, 9}};
    for (const Affine3d& m :
         {Affine3d{}, Affine3d::translate({1e6, -2e6, 3}) * Affine3d::scale({0.1, 0.1, 0.1}),
          Affine3d::rotate(1, 30) * Affine3d::scale({1, 2, 3}), Affine3d::scale({-1, 1, 1}),
          sheared}) {
        const LoadedGrid grid = load({.voxels = {{{3, 4, 5}, {1}}}, .worldFromIndex = m});
        const Vec3d expected = m.point({3, 4, 5});
        const Vec3d found = grid.worldFromIndex.point({3, 4, 5});
        EXPECT_NEAR(length(found - expected), 0, 1e-12 * (1 + length(expected)));
        EXPECT_NEAR(grid.worldFromIndex.determinant(), m.determinant(), 1e-9);
    }
}

TEST_F(VdbLoad, FaultsAreCountedPlacedAndRefused) {
    GridSpec spec{.tiles = {{{-8, 0, 0}, 8, {-1}}},
                  .voxels = {{{9, 0, 0}, {nan}},
                             {{2, 8, 3}, {nan}, false},
                             {{2, 9, 0}, {nan}},
                             {{1, 1, 1}, {infinity}},
                             {{0, 0, 7}, {-1e-20}},
                             {{0, 0, 6}, {4}}}};
    expectRefused(spec, "grid 'density' in " + name() +
                            " holds 3 NaN voxels (first at [2, 8, 3]), 1 infinite voxel (first at "
                            "[1, 1, 1]), 513 negative voxels (first at [-8, 0, 0]); --repair (in a "
                            "scene file: repair = true) sets them to zero");
    const LoadedGrid grid = load(spec, {.repair = true});
    ASSERT_EQ(grid.notes.size(), 1u);
    EXPECT_EQ(grid.notes[0], "grid 'density' in " + name() +
                                 ": set to zero: 3 NaN voxels (first at [2, 8, 3]), 1 infinite "
                                 "voxel (first at [1, 1, 1]), 513 negative voxels (first at "
                                 "[-8, 0, 0])");
    EXPECT_EQ(grid.field.voxel({0, 0, 6}), 4);
    for (Vec3i v :
         {Vec3i{9, 0, 0}, Vec3i{2, 8, 3}, Vec3i{1, 1, 1}, Vec3i{0, 0, 7}, Vec3i{-3, 2, 2}})
        EXPECT_EQ(grid.field.voxel(v), 0);
    EXPECT_EQ(grid.field.range(), (Range{0, 4}));
}

TEST_F(VdbLoad, FaultyBackgroundsAndDoublesBeyondFloat) {
    expectRefused({.background = {-0.5}, .voxels = {{{0, 0, 0}, {1}}}},
                  "holds 511 negative voxels (first at [0, 0, 1]), a background of -0.5; --repair");
    expectRefused({.type = VdbType::Double, .voxels = {{{0, 0, 5}, {1e39}}}},
                  "holds 1 infinite voxel (first at [0, 0, 5])");
}

TEST_F(VdbLoad, NegativeValuesAreFineWhereTheyMeanSomething) {
    const GridSpec spec{.name = "v", .type = VdbType::Vec3s, .voxels = {{{0, 0, 0}, {-1, 2, -3}}}};
    const LoadedGrid grid = load(spec, {.use = GridUse::Colour, .nonNegative = false});
    EXPECT_EQ(grid.field.voxel({0, 0, 0}, 2), -3);
    expectRefused(spec, "1 negative voxel (first at [0, 0, 0])", {.use = GridUse::Colour});
}

TEST_F(VdbLoad, GridsWithoutActiveVoxelsAreNoted) {
    const LoadedGrid empty = load({.background = {0.5}});
    EXPECT_TRUE(empty.empty);
    EXPECT_EQ(empty.notes,
              std::vector{"grid 'density' in " + name() + " is empty: it has no active voxels"});
    EXPECT_EQ(empty.field.range(), (Range{0.5f, 0.5f}));
    const GridSpec inactive{.voxels = {{{0, 0, 0}, {2}, false}, {{9, 0, 0}, {3}, false}}};
    const LoadedGrid off = load(inactive);
    EXPECT_TRUE(off.empty);
    EXPECT_EQ(off.notes, std::vector{"grid 'density' in " + name() +
                                     " has no active voxels, but 2 inactive ones with values other "
                                     "than the background; activate them if they are meant to be "
                                     "seen (Houdini: VDB Activate)"});
    EXPECT_EQ(off.field.voxel({9, 0, 0}), 3);
    EXPECT_FALSE(load({.voxels = {{{0, 0, 0}, {0}}}}).empty);  // an active zero
}

TEST_F(VdbLoad, NothingIsLeftOfAMediumWithoutActiveVoxels) {
    for (const GridSpec& spec :
         {GridSpec{.background = {0.5}}, GridSpec{.voxels = {{{0, 0, 0}, {2}, false}}},
          GridSpec{.tiles = {{{0, 0, 0}, 128, {2}, false}}}}) {
        const LoadedGrid grid = load(spec, {.reach = GridReach::ActiveVoxels});
        EXPECT_TRUE(grid.empty);
        EXPECT_EQ(grid.notes.size(), 1u);
        EXPECT_EQ(grid.field.range(), (Range{0, 0}));
        EXPECT_TRUE(grid.field.extent().empty());
    }
}

TEST_F(VdbLoad, ABackgroundReachesOneVoxelBeyondTheActiveOnes) {
    const GridSpec spec{.background = {0.25},
                        .tiles = {{{8, 0, -8}, 8, {0.25}}, {{128, 0, 0}, 128, {3}, false}},
                        .voxels = {{{0, 0, 0}, {1}}, {{-3, 5, 20}, {2}}, {{40, 0, 0}, {9}, false}}};
    const LoadOptions within{.reach = GridReach::ActiveVoxels};
    const LoadedGrid grid = load(spec, within);
    ASSERT_TRUE(grid.field.limits());
    EXPECT_EQ(grid.field.limits()->lower, (Vec3d{-4, -1, -9}));
    EXPECT_EQ(grid.field.limits()->upper, (Vec3d{16, 8, 21}));
    EXPECT_EQ(grid.field.extent().upper, (Vec3d{16, 8, 21}));
    EXPECT_EQ(grid.field.background(), 0.25f);  // between the voxels
    EXPECT_EQ(grid.notes, std::vector{"grid 'density' in " + name() +
                                      " has a background of 0.25: only what lies within the bounds "
                                      "of its active voxels is drawn"});
    const LoadedGrid everywhere = load(spec);
    EXPECT_FALSE(everywhere.field.limits());
    EXPECT_TRUE(everywhere.notes.empty());
    const LoadedGrid zero = load({.voxels = {{{0, 0, 0}, {1}}}}, within);
    EXPECT_FALSE(zero.field.limits());
    EXPECT_TRUE(zero.notes.empty());
    const LoadedGrid colour = load(
        {.type = VdbType::Vec3s, .background = {0, 0.5, 0}, .voxels = {{{0, 0, 0}, {1, 1, 1}}}},
        {.use = GridUse::Colour, .reach = GridReach::ActiveVoxels});
    EXPECT_TRUE(colour.field.limits());
    EXPECT_EQ(colour.notes.at(0), "grid 'density' in " + name() +
                                      " has a background of [0, 0.5, 0]: only what lies within the "
                                      "bounds of its active voxels is drawn");
    // What is repaired is not there.
    const LoadedGrid repaired = load({.background = {-1}, .voxels = {{{0, 0, 0}, {1}}}},
                                     {.reach = GridReach::ActiveVoxels, .repair = true});
    EXPECT_FALSE(repaired.field.limits());
}

TEST_F(VdbLoad, KindsThatCannotBeRenderedSayWhatToDo) {
    const std::vector<VdbVoxel> one{{{0, 0, 0}, {1, 1, 1}}};
    expectRefused({.voxels = one, .gridClass = "level set"},
                  "cannot be used: it is a level set (distances, no density); convert it to a fog");
    expectRefused({.voxels = one, .frustum = true}, "its transform is a frustum");
    expectRefused({.type = VdbType::Points}, "it holds points and no values");
    expectRefused(
        {.type = VdbType::Vec3s, .voxels = one},
        "is a vector grid (vec3s) where a scalar one is needed; scalar grids there: none");
    const LoadedGrid grey = load({.voxels = one}, {.use = GridUse::Colour});
    EXPECT_EQ(grey.field.channels(), 1);
}

TEST_F(VdbLoad, UnknownClassIsFineAndStaggeredIsNoted) {
    const std::vector<VdbVoxel> one{{{0, 0, 0}, {1}}};
    EXPECT_TRUE(load({.voxels = one, .gridClass = "unknown"}).notes.empty());
    const LoadedGrid staggered = load({.voxels = one, .gridClass = "staggered"});
    ASSERT_EQ(staggered.notes.size(), 1u);
    EXPECT_NE(staggered.notes[0].find("is staggered"), std::string::npos);
}

TEST_F(VdbLoad, HalfStorageThatOverflowsNamesTheGrid) {
    expectRefused({.voxels = {{{0, 0, 0}, {1e6}}}},
                  "grid 'density' in " + name() + ": a voxel exceeds 65504",
                  {.storage = Storage::Half});
}

TEST_F(VdbLoad, StreamedFilesWithoutOffsets) {
    streamVdb(file_, {{.name = "a", .voxels = {{{1, 2, 3}, {4}}}},
                      {.name = "b", .voxels = {{{3, 2, 1}, {5}}}}});
    EXPECT_EQ(loadGrid(file_, "a").field.voxel({1, 2, 3}), 4);
    EXPECT_EQ(loadGrid(file_, "b").field.voxel({3, 2, 1}), 5);
}

TEST_F(VdbLoad, TheMeanIsTheSameEachTime) {
    GridSpec spec{.box = {{-40, -40, -40}, {40, 40, 40}}};
    spec.value = [](Vec3i v) { return 0.1 + std::sin(0.1 * v.x) * std::sin(0.2 * v.y + v.z) / 16; };
    const double mean = load(spec).statistics.voxels.mean();
    double sum = 0;
    for (int x = -40; x <= 40; ++x)
        for (int y = -40; y <= 40; ++y)
            for (int z = -40; z <= 40; ++z)
                sum += static_cast<double>(static_cast<float>(spec.value({x, y, z})));
    EXPECT_NEAR(mean, sum / (81.0 * 81 * 81), 1e-12);
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(loadGrid(file_, "density").statistics.voxels.mean(), mean);
}

TEST(VdbAssets, TeapotCloudIsWhatOpenVdbSaysItIs) {  // numbers of `vdb_print -l`
    const auto file = sharedDir() / "assets/teapot_cloud.vdb";
    if (!exists(file)) GTEST_SKIP() << "no " << file;
    const LoadedGrid grid = loadGrid(file, "density");
    const GridStatistics& s = grid.statistics;
    EXPECT_EQ(s.voxels.active, 1963736u);
    EXPECT_EQ(s.activeTiles, 2326u);
    EXPECT_EQ(s.leaves, 2865u);
    EXPECT_EQ(s.activeBounds.lower, (Vec3i{-136, -60, -90}));
    EXPECT_EQ(s.activeBounds.upper, (Vec3i{130, 73, 87}));
    EXPECT_NEAR(s.voxels.min[0], 3.49915e-07, 1e-12);
    EXPECT_EQ(s.voxels.max[0], 50);
    EXPECT_EQ(s.openVdbBytes, 8779904u);
    EXPECT_NEAR(grid.worldFromIndex.column[0].x, 0.00767, 5e-6);
    EXPECT_LE(grid.field.bytes(), s.openVdbBytes);
    EXPECT_TRUE(grid.notes.empty());
    const LoadedGrid half = loadGrid(file, "density", {.storage = Storage::Half});
    EXPECT_LE(static_cast<double>(half.field.bytes()), 0.75 * static_cast<double>(s.openVdbBytes));
}

TEST(VdbAssets, FireCacheAndItsTraps) {
    const auto file = sharedDir() / "assets/fire_0045.vdb";
    if (!exists(file)) GTEST_SKIP() << "no " << file;
    const LoadedGrid density = loadGrid(file, "density");
    EXPECT_EQ(density.statistics.voxels.active, 618500u);
    EXPECT_EQ(density.field.storage(), Storage::Half);
    EXPECT_NEAR(density.statistics.voxels.max[0], 0.783203, 1e-6);
    expectError(ErrorKind::Input, "holds 1327104 negative voxels (first at [0, 0, 0])",
                [&] { loadGrid(file, "shadow"); });
    expectError(ErrorKind::Input, "scalar grids there: density, shadow, temperature, flame",
                [&] { loadGrid(file, "velocity"); });
    const LoadedGrid velocity =
        loadGrid(file, "velocity", {.use = GridUse::Colour, .nonNegative = false});
    EXPECT_EQ(velocity.statistics.voxels.active, 618500u);
    ASSERT_EQ(velocity.notes.size(), 1u);
}

}  // namespace
}  // namespace woodcock::test
