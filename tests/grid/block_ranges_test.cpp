// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/block_ranges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

const std::array<float, 3> haze{0.25f, 0.125f, 0.5f};

std::vector<PlainGrid> grids() {
    return {mixedGrid(1),          mixedGrid(2, 1, haze),    mixedGrid(3, 3),
            mixedGrid(4, 3, haze), scatteredGrid(5),         scatteredGrid(6, 1, haze),
            scatteredGrid(7, 3),   scatteredGrid(8, 3, haze)};
}

TEST(BlockRanges, AreExactlyWhatInterpolationTouches) {
    for (const PlainGrid& grid : grids()) {
        const Field field = grid.field();
        const BlockTable<Range> ranges = blockRanges(field);
        for (Vec3i leaf : grid.leaves())
            for (int i = 0; i < 27; ++i) {
                const Vec3i v = leaf + Vec3i{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1} * 8;
                const Vec3i block{v.x >> 3, v.y >> 3, v.z >> 3};
                const Range exact = grid.range(v, v + Vec3i{8, 8, 8});
                EXPECT_EQ(blockRange(field, block), exact) << v.x << " " << v.y << " " << v.z;
                const auto found = ranges.find(block);
                if (found.log2Size > blockLog2) continue;  // shared: see below
                EXPECT_EQ(*found.value, exact) << v.x << " " << v.y << " " << v.z;
            }
    }
}

TEST(BlockRanges, SharedOnesBoundEveryPointOfTheirCube) {
    for (const PlainGrid& grid : grids()) {
        const Field field = grid.field();
        const BlockTable<Range> ranges = blockRanges(field);
        RandomStream random(2);
        const auto expectBounds = [&](Vec3i origin, int size) {
            for (int i = 0; i < 400; ++i) {
                const Vec3d u{random.uniform(), random.uniform(), random.uniform()};
                const Vec3d p = origin.as<double>() - Vec3d{2, 2, 2} + u * (size + 4.0);
                const Vec3i v = floorToInt(p);
                const Range r = *ranges.find({v.x >> 3, v.y >> 3, v.z >> 3}).value;
                for (int c = 0; c < grid.channels(); ++c) {
                    ASSERT_LE(r.min, field.trilinear(p, c));
                    ASSERT_GE(r.max, field.trilinear(p, c));
                }
                ASSERT_LE(field.range().min, r.min);
                ASSERT_GE(field.range().max, r.max);
            }
        };
        for (Vec3i o : grid.leaves()) expectBounds(o, 8);
        for (const FieldTile& t : grid.tiles()) expectBounds(t.origin, t.size);
    }
}

TEST(BlockRanges, TheInsideOfALargeTileIsFlat) {
    const Field field = scatteredGrid(5).field();
    const Vec3i inside{4096 / 8 + 100, -8192 / 8 + 200, 300};
    const auto found = blockRanges(field).find(inside);
    EXPECT_GE(found.log2Size, regionLog2);
    EXPECT_EQ(blockRange(field, inside), (Range{0.5f, 0.5f}));
}

TEST(BlockRanges, OfAHugeTileCostLittle) {
    PlainGrid grid;
    grid.setTile({-4096, 0, 4096}, 4096, {1});
    grid.setTile({0, 0, 4096}, 4096, {1});
    const Field field = grid.field();
    const BlockTable<Range> ranges = blockRanges(field);
    EXPECT_LT(ranges.bytes(), 4u << 20);
    EXPECT_EQ(*ranges.find({-1, 256, 768}).value, (Range{1, 1}));
    EXPECT_EQ(*ranges.find({511, 256, 768}).value, (Range{0, 1}));
}

/// 17 bytes of a file each: what they take must not grow with the 32768 regions of each.
TEST(BlockRanges, OfThousandsOfHugeTilesCostLittleEach) {
    FieldSource source;
    constexpr int side = 20;
    for (int i = 0; i < side * side * side; ++i)
        source.tiles.push_back({Vec3i{i % side, i / side % side, i / side / side} * 4096,
                                4096,
                                {1 + static_cast<float>(i % 7)}});
    const Field field = buildField(source, Storage::Float);
    EXPECT_LT(field.bytes(), 1000 * 17 * source.tiles.size());
    const BlockTable<Range> ranges = blockRanges(field);
    EXPECT_LT(ranges.bytes(), 400 * 17 * source.tiles.size());
    RandomStream random(3);
    for (int i = 0; i < 20000; ++i) {
        const Vec3d u{random.uniform(), random.uniform(), random.uniform()};
        Vec3d p = u * (4096.0 * (side + 2)) - Vec3d{1, 1, 1} * 4096;
        for (int a = 0; a < 3; ++a)  // half of the coordinates next to a tile's face
            if (random.uniform() < 0.5)
                p[a] = 4096 * std::round(p[a] / 4096) + random.uniform() - 1;
        const Vec3i v = floorToInt(p);
        const Range r = *ranges.find({v.x >> 3, v.y >> 3, v.z >> 3}).value;
        const float value = field.trilinear(p);
        ASSERT_LE(r.min, value * (1 + 1e-6f));
        ASSERT_GE(r.max, value * (1 - 1e-6f));
    }
}

}  // namespace
}  // namespace woodcock::test
