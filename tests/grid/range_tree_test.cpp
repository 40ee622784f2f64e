// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/range_tree.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

int upTo(RandomStream& random, int n) { return static_cast<int>(random.uniform() * n); }

/// Boxes in and around the leaves and tiles of a grid.
std::vector<Box3i> boxesAround(const PlainGrid& grid, int widest, int count) {
    std::vector<Vec3i> places = grid.leaves();
    for (const FieldTile& tile : grid.tiles()) places.push_back(tile.origin);
    std::vector<Box3i> boxes;
    RandomStream random(3);
    for (int i = 0; i < count; ++i) {
        const Vec3i at = places[static_cast<std::size_t>(upTo(random, int(places.size())))];
        const Vec3i lower =
            at + Vec3i{upTo(random, 16) - 8, upTo(random, 16) - 8, upTo(random, 16) - 8};
        boxes.push_back({lower, lower + Vec3i{upTo(random, widest), upTo(random, widest),
                                              upTo(random, widest)}});
    }
    return boxes;
}

Range exact(const PlainGrid& grid, const Box3i& box, int channel) {
    Range r{1e9f, -1e9f};
    for (int x = box.lower.x; x <= box.upper.x; ++x)
        for (int y = box.lower.y; y <= box.upper.y; ++y)
            for (int z = box.lower.z; z <= box.upper.z; ++z) {
                const float v = grid.voxel({x, y, z}, channel);
                r.add({v, v});
            }
    return r;
}

TEST(RangeTree, IsExactForSmallBoxes) {
    const std::array<float, 3> haze{0.25f, 0.125f, 0.5f};
    for (const PlainGrid& grid :
         {mixedGrid(1), mixedGrid(4, 3, haze), scatteredGrid(5), scatteredGrid(8, 3, haze)}) {
        const auto field = std::make_shared<const Field>(grid.field());
        const RangeTree all(field);
        for (int c = 0; c < grid.channels(); ++c) {
            const RangeTree tree(field, c);
            for (const Box3i& box : boxesAround(grid, 15, 300)) {
                EXPECT_EQ(tree.range(box), exact(grid, box, c));
                EXPECT_LE(all.range(box).min, exact(grid, box, c).min);
                EXPECT_GE(all.range(box).max, exact(grid, box, c).max);
            }
        }
    }
}

TEST(RangeTree, BoundsLargeBoxes) {
    for (const PlainGrid& grid : {mixedGrid(2), scatteredGrid(6)}) {
        const RangeTree tree(std::make_shared<const Field>(grid.field()));
        for (const Box3i& box : boxesAround(grid, 70, 60)) {
            const Range r = tree.range(box), within = exact(grid, box, 0);
            EXPECT_LE(r.min, within.min);
            EXPECT_GE(r.max, within.max);
        }
    }
}

TEST(RangeTree, OfNothingIsTheBackground) {
    FieldSource source;
    source.background = {0.5f, 0, 0};
    const RangeTree tree(std::make_shared<const Field>(buildField(source, Storage::Float)));
    EXPECT_EQ(tree.range({{-5, -5, -5}, {1 << 30, 5, 5}}), (Range{0.5f, 0.5f}));
}

}  // namespace
}  // namespace woodcock::test
