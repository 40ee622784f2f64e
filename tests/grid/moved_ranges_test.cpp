// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/moved_ranges.h"

#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/grid/block_ranges.h"
#include "woodcock/grid/majorants.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

std::shared_ptr<const Velocity> velocityOf(const PlainGrid& grid) {
    const auto field = std::make_shared<const Field>(grid.field());
    std::array<Velocity::Source, 3> sources;
    for (int c = 0; c < 3; ++c) sources[static_cast<std::size_t>(c)] = {field, c, {}};
    return std::make_shared<const Velocity>(std::move(sources));
}

/// Leaves and a tile, too far apart for a flat table.
PlainGrid farApart(int channels, std::array<float, 3> background = {}) {
    PlainGrid grid(channels, background);
    for (const Vec3i at : {Vec3i{0, 0, 0}, {8, 0, 0}, {30000, -800, 16}, {-200000, 8, 8000}})
        grid.setLeaf(at, [](Vec3i v, int c) {
            return static_cast<float>(RandomStream(hashOf(v.x, v.y, v.z, c)).uniform());
        });
    grid.setTile({128, 0, -128}, 128, {0.5f, 0.25f, 1});
    return grid;
}

/// Of any size up to `fastest` in the leaves of another grid, and of 50 times as much at a voxel.
PlainGrid wildVelocity(const PlainGrid& where, double fastest, std::array<float, 3> around = {}) {
    PlainGrid grid(3, around);
    const Vec3i outlier = where.leaves().front() + Vec3i{3, 4, 5};
    for (const Vec3i origin : where.leaves())
        grid.setLeaf(origin, [&](Vec3i v, int c) {
            const double u = RandomStream(hashOf(9, v.x >> 1, v.y >> 1, v.z >> 1, c)).uniform();
            return static_cast<float>(fastest * (v == outlier ? 50 : 2 * u - 1));
        });
    return grid;
}

struct Moving {
    PlainGrid plain;
    std::shared_ptr<const Field> field;
    std::shared_ptr<const Motion> motion;
};

std::vector<Moving> moving() {
    std::vector<Moving> all;
    const std::array<float, 3> haze{0.25f, 0.125f, 0.5f};
    const auto add = [&](const PlainGrid& grid, double fastest, std::array<float, 3> around,
                         bool limited) {
        FieldSource source = grid.source();
        if (limited) source.within = Box3i{{-3, -9, -5}, {12, 11, 6}};
        all.push_back({grid, std::make_shared<const Field>(buildField(source, Storage::Float)),
                       std::make_shared<const Motion>(
                           velocityOf(wildVelocity(grid, fastest, around)), Affine3d{}, -0.5, 1)});
    };
    for (const double fastest : {0.01, 1.0, 20.0}) {
        add(mixedGrid(1), fastest, {}, false);
        add(mixedGrid(4, 3, haze), fastest, {0, 2, -7}, false);
        add(mixedGrid(5, 1, haze), fastest, {}, true);
    }
    add(farApart(1), 0.5, {}, false);
    add(farApart(3, haze), 0.5, {30, 0, 0}, false);
    return all;
}

float valueAt(const Moving& m, Vec3d p, float time, int channel) {
    const Vec3d from = m.motion->source(p, time);
    if (m.field->limits() && !m.field->limits()->contains(from)) return 0;
    return m.field->trilinear(m.field->nearSupport(from), channel);
}

Vec3d somewhere(const Moving& m, RandomStream& random) {
    const auto& leaves = m.plain.leaves();
    const auto i = static_cast<std::size_t>(random.uniform() * static_cast<double>(leaves.size()));
    const double wide = random.uniform() < 0.5 ? 12 : 200;
    return leaves[i].as<double>() + Vec3d{4, 4, 4} +
           (Vec3d{random.uniform(), random.uniform(), random.uniform()} - Vec3d{0.5, 0.5, 0.5}) *
               wide;
}

TEST(MovedRanges, BoundTheMovedFieldAtAllTimes) {
    RandomStream random(4);
    for (const Moving& m : moving()) {
        const MovedRanges moved(m.field, m.motion);
        const auto finest = [&](Vec3i block) { return moved.finest(block); };
        const MajorantGrid coarse(moved.blocks(), finest, {0.3, 1, 1});
        const MajorantGrid fine(moved.blocks(), finest, {1e6, 1, 1});
        int inside = 0;
        for (int i = 0; i < 1500; ++i) {
            const Vec3d p = somewhere(m, random);
            const auto time = static_cast<float>(random.uniform());
            for (int c = 0; c < m.field->channels(); ++c) {
                const float f = valueAt(m, p, time, c);
                if (moved.support().contains(p)) {
                    ++inside;
                    for (const MajorantGrid* majorants : {&coarse, &fine}) {
                        const Range r = majorants->find(floorToInt(p)).range;
                        ASSERT_LE(r.min, f * (1 + 1e-6f));
                        ASSERT_GE(r.max * (1 + 1e-6f), f);
                    }
                } else {
                    ASSERT_EQ(f, m.field->limits() ? 0 : m.field->background(c));
                }
            }
            const double width = std::pow(10.0, -3 * random.uniform());
            const Box3d box{p, p + Vec3d{1, 1, 1} * width};
            const Vec3d q = p + Vec3d{random.uniform(), random.uniform(), random.uniform()} * width;
            const Range close = moved.close(box, time, 0);
            ASSERT_LE(close.min, valueAt(m, q, time, 0) * (1 + 1e-6f));
            ASSERT_GE(close.max * (1 + 1e-6f), valueAt(m, q, time, 0));
        }
        EXPECT_GT(inside, 200);
    }
}

/// One voxel does not loosen the bounds of all.
TEST(MovedRanges, OutliersLoosenWhatIsNearThem) {
    const PlainGrid grid = mixedGrid(5);
    const auto field = std::make_shared<const Field>(grid.field());
    const auto share = [&](double fastest) {
        const auto motion = std::make_shared<const Motion>(velocityOf(wildVelocity(grid, fastest)),
                                                           Affine3d{}, 0, 1);
        return MovedRanges(field, motion).looseShare();
    };
    EXPECT_EQ(share(0.01), 0);
    EXPECT_GT(share(0.4), 0);  // the outlier moves by 20 voxels
    EXPECT_LT(share(0.4), 0.5);
    EXPECT_GT(share(20), 0.5);
}

TEST(MovedRanges, OfWhatHardlyMovesAreThoseOfWhatStands) {
    const PlainGrid grid = mixedGrid(1);
    const auto field = std::make_shared<const Field>(grid.field());
    PlainGrid elsewhere(3);
    elsewhere.setLeaf({800, 0, 0}, [](Vec3i, int) { return 1.0f; });
    const MovedRanges moved(
        field, std::make_shared<const Motion>(velocityOf(elsewhere), Affine3d{}, 0, 1));
    blockRanges(*field).forEach(
        [&](Vec3i b, int, Range r) { EXPECT_EQ(*moved.blocks().find(b).value, r); });
}

}  // namespace
}  // namespace woodcock::test
