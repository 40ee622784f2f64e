// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/majorants.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/grid/block_ranges.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

const std::array<float, 3> haze{0.25f, 0.125f, 0.5f};

std::vector<PlainGrid> grids() {
    return {mixedGrid(1), mixedGrid(4, 3, haze), scatteredGrid(5), scatteredGrid(8, 3, haze)};
}

/// Many for small fields, a few for large ones.
std::vector<MajorantGrid::Options> optionsFor(const Field& field) {
    if (!field.blocks().dense()) return {{0.01, 1, 1}, {3, 1, 1}, {1, 2, 5}};
    std::vector<MajorantGrid::Options> options;
    for (double depthPerVoxel : {1e-12, 0.01, 0.3, 1.0, 3.0, 1e12})
        options.push_back({depthPerVoxel, 1, 1});
    for (int smallestLog2 : {2, 3, 4, 5, 7}) options.push_back({1, 1, smallestLog2});
    options.push_back({1, 8, 1}), options.push_back({0.1, 2, 3});
    return options;
}

Vec3i corner(Vec3i v, int log2Size) {
    const int mask = ~((1 << log2Size) - 1);
    return {v.x & mask, v.y & mask, v.z & mask};
}

/// Points of the support in and around every leaf and tile.
std::vector<Vec3d> points(const PlainGrid& grid, int each) {
    std::vector<Vec3d> p;
    RandomStream random(1);
    const Box3d support = grid.support();
    const auto around = [&](Vec3i origin, int size) {
        for (int i = 0; i < each; ++i) {
            const Vec3d u{random.uniform(), random.uniform(), random.uniform()};
            const Vec3d q = origin.as<double>() - Vec3d{2, 2, 2} + u * (size + 4.0);
            if (support.contains(q)) p.push_back(q);
        }
    };
    for (Vec3i o : grid.leaves()) around(o, 8);
    for (const FieldTile& t : grid.tiles()) around(t.origin, t.size);
    return p;
}

TEST(Majorants, BoundTheFieldEverywhere) {
    for (const PlainGrid& grid : grids()) {
        const Field field = grid.field();
        const std::vector<Vec3d> where = points(grid, 200);
        for (const MajorantGrid::Options& options : optionsFor(field)) {
            const MajorantGrid majorants(field, options);
            for (Vec3d p : where) {
                const MajorantGrid::Cell cell = majorants.find(floorToInt(p));
                ASSERT_GE(cell.log2Size, options.smallestLog2);
                ASSERT_LE(cell.log2Size, superLog2);
                for (int c = 0; c < grid.channels(); ++c) {
                    ASSERT_LE(cell.range.min, field.trilinear(p, c));
                    ASSERT_GE(cell.range.max * (1 + 1e-6), field.trilinear(p, c) * options.scale);
                }
            }
        }
    }
}

TEST(Majorants, AreAsTightAsTheirCellsAllow) {
    std::array<int, 8> cellsOfSize{};
    for (const PlainGrid& grid : {mixedGrid(1), mixedGrid(4, 3, haze), scatteredGrid(5)}) {
        const Field field = grid.field();
        const BlockTable<Range> ranges = blockRanges(field);
        const std::vector<Vec3d> where = points(grid, 12);
        for (const MajorantGrid::Options& options : optionsFor(field)) {
            const MajorantGrid majorants(field, options);
            for (Vec3d p : where) {
                const Vec3i v = floorToInt(p);
                const MajorantGrid::Cell cell = majorants.find(v);
                if (cell.log2Size > 4 || ranges.find({v.x >> 3, v.y >> 3, v.z >> 3}).log2Size > 3)
                    continue;
                ++cellsOfSize[static_cast<std::size_t>(cell.log2Size)];
                const Vec3i low = corner(v, cell.log2Size);
                const int n = 1 << cell.log2Size;
                const Range exact = grid.range(low, low + Vec3i{n, n, n});
                const double max = exact.max * options.scale;
                ASSERT_LE(cell.range.min, exact.min);
                ASSERT_GE(cell.range.max, max);
                const double rounding = cell.log2Size < 3 ? 0.01 : 0;
                ASSERT_GE(cell.range.min, exact.min * (1 - rounding));
                ASSERT_LE(cell.range.max, max * (1 + rounding));
            }
        }
    }
    for (std::size_t log2Size = 1; log2Size <= 4; ++log2Size)
        EXPECT_GT(cellsOfSize[log2Size], 100) << "too few cells of this size to mean anything";
}

TEST(Majorants, CellsAreWholeCubes) {
    for (const PlainGrid& grid : {mixedGrid(2), scatteredGrid(6)}) {
        const Field field = grid.field();
        const MajorantGrid majorants(field, {0.05, 1, 1});
        RandomStream random(2);
        for (Vec3d p : points(grid, 30)) {
            const MajorantGrid::Cell cell = majorants.find(floorToInt(p));
            const Vec3i low = corner(floorToInt(p), cell.log2Size);
            for (int i = 0; i < 20; ++i) {
                const double n = 1 << cell.log2Size;
                const Vec3i v =
                    low +
                    floorToInt(Vec3d{random.uniform(), random.uniform(), random.uniform()} * n);
                if (!field.support().contains(v.as<double>())) continue;
                ASSERT_EQ(majorants.find(v).log2Size, cell.log2Size);
                ASSERT_EQ(majorants.find(v).range, cell.range);
            }
        }
    }
}

TEST(Majorants, CellsGrowAsTheMediumThins) {
    const Field field = mixedGrid(1).field();
    double last = 1e9;
    for (double depthPerVoxel : {1e-6, 0.01, 0.1, 1.0, 10.0}) {
        const MajorantStatistics s =
            majorantStatistics(field, MajorantGrid(field, {depthPerVoxel, 1, 1}), 2000);
        EXPECT_LT(s.majorantOverMean, last + 1e-9);
        EXPECT_GE(s.majorantOverMean, 1);
        EXPECT_GE(s.segmentsPerRay, 1);
        last = s.majorantOverMean;
    }
}

TEST(Majorants, StatisticsOfAFlatCubeAreKnown) {
    PlainGrid grid;
    grid.setTile({0, 0, 0}, 128, {2});
    const Field field = grid.field();
    const MajorantStatistics tight =
        majorantStatistics(field, MajorantGrid(field, {1, 1, 1}), 4000);
    const MajorantStatistics loose =
        majorantStatistics(field, MajorantGrid(field, {1, 3, 1}), 4000);
    // Flat but for the ramps of one voxel at its faces.
    EXPECT_GE(tight.majorantOverMean, 1);
    EXPECT_LE(tight.majorantOverMean, 1.1);
    EXPECT_NEAR(loose.majorantOverMean, 3, 0.3);
    EXPECT_GT(tight.rays, 1000u);
}

}  // namespace
}  // namespace woodcock::test
