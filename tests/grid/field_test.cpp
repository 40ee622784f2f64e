// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/field.h"
#include "tests/support/expect_mean.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/random.h"
#include "woodcock/proof/support/plain_grid.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

const std::array<float, 3> zero{}, haze{0.25f, 0.125f, 0.5f};

/// Both table kinds, one and three channels, with and without a background.
std::vector<PlainGrid> grids() {
    return {mixedGrid(1),          mixedGrid(2, 1, haze),    mixedGrid(3, 3),
            mixedGrid(4, 3, haze), scatteredGrid(5),         scatteredGrid(6, 1, haze),
            scatteredGrid(7, 3),   scatteredGrid(8, 3, haze)};
}

Vec3d pointIn(const Box3d& box, RandomStream& random) {
    return box.lower + box.size() * Vec3d{random.uniform(), random.uniform(), random.uniform()};
}

/// Points in and around every leaf and tile.
std::vector<Vec3d> points(const PlainGrid& grid, int each, std::uint64_t seed) {
    std::vector<Vec3d> p;
    RandomStream random(seed);
    const auto around = [&](Vec3i origin, int size) {
        const Vec3d low = origin.as<double>();
        const Box3d box{low - Vec3d{2, 2, 2}, low + Vec3d{2, 2, 2} + Vec3d{1, 1, 1} * size};
        for (int i = 0; i < each; ++i) p.push_back(pointIn(box, random));
        for (int i = 0; i < 8; ++i) p.push_back(Box3d{low, low + Vec3d{1, 1, 1} * size}.corner(i));
    };
    for (Vec3i o : grid.leaves()) around(o, 8);
    for (const FieldTile& t : grid.tiles()) around(t.origin, t.size);
    return p;
}

TEST(Field, EveryVoxelIsWhatTheSourceSays) {
    for (const PlainGrid& grid : grids())
        for (Storage storage : {Storage::Half, Storage::Float}) {
            const Field field = grid.field(storage);
            EXPECT_EQ(field.channels(), grid.channels());
            EXPECT_EQ(field.storage(), storage);
            EXPECT_EQ(field.brickCount(), grid.leaves().size());
            const auto expectVoxel = [&](Vec3i v) {
                for (int c = 0; c < grid.channels(); ++c)
                    ASSERT_EQ(field.voxel(v, c), grid.voxel(v, c))
                        << v.x << " " << v.y << " " << v.z;
            };
            for (Vec3i leaf : grid.leaves())
                for (int i = 0; i < 1000; ++i)
                    expectVoxel(leaf + Vec3i{i / 100 - 1, i / 10 % 10 - 1, i % 10 - 1});
            for (Vec3d p : points(grid, 500, 1)) expectVoxel(floorToInt(p));
            expectVoxel({1 << 28, -1 << 28, 1 << 29});
        }
}

TEST(Field, TablesAreFlatNearbyAndSparseFarApart) {
    EXPECT_TRUE(mixedGrid(1).field().blocks().dense());
    EXPECT_FALSE(scatteredGrid(1).field().blocks().dense());
}

TEST(Field, SupportIsOneVoxelAroundAllThatDiffersFromTheBackground) {
    for (const PlainGrid& grid : grids()) EXPECT_EQ(grid.field().support(), grid.support());
    PlainGrid one;
    one.setLeaf({-8, 0, 16}, [](Vec3i v, int) { return v == Vec3i{-3, 2, 20} ? 1.0f : 0.0f; });
    EXPECT_EQ(one.field().support(), (Box3d{{-4, 1, 19}, {-2, 3, 21}}));
    PlainGrid none(1, haze);
    none.setLeaf({0, 0, 0}, [](Vec3i, int) { return haze[0]; });
    none.setTile({8, 8, 8}, 8, haze);
    EXPECT_TRUE(none.field().support().empty());
    EXPECT_TRUE(PlainGrid().field().support().empty());
    EXPECT_EQ(PlainGrid(1, haze).field().trilinear({1e6, 0.5, -7}), haze[0]);
}

TEST(Field, EveryFiniteHalfIsReadExactly) {
    std::vector<float> values;
    for (int sign : {1, -1})
        for (int exponent = 0; exponent < 31; ++exponent)
            for (int digits = 0; digits < 1024; ++digits)
                values.push_back(
                    static_cast<float>(sign * std::ldexp(exponent ? 1024 + digits : digits,
                                                         std::max(exponent, 1) - 25)));
    ASSERT_EQ(values.size(), 63488u);  // 2^16 without the infinities and NaNs
    PlainGrid grid;
    for (int leaf = 0; leaf < 124; ++leaf)
        grid.setLeaf({leaf * 8, 0, 0}, [&, i = 512 * leaf](Vec3i, int) mutable {
            return values[static_cast<std::size_t>(i++)];
        });
    for (Storage storage : {Storage::Half, Storage::Auto}) {
        const Field field = grid.field(storage);
        ASSERT_EQ(field.storage(), Storage::Half);
        for (int i = 0; i < 63488; ++i)
            ASSERT_EQ(field.voxel({i / 512 * 8 + (i >> 6 & 7), i >> 3 & 7, i & 7}),
                      values[static_cast<std::size_t>(i)]);
    }
}

TEST(Field, AutoTakesFloatForWhatHalfWouldChange) {
    for (float odd : {0.1f, 65505.0f, 0x1p-25f, 1 + 0x1p-11f}) {
        PlainGrid grid;
        grid.setLeaf({0, 0, 0}, [&](Vec3i v, int) { return v.x == 3 ? odd : 1.0f; });
        const Field field = grid.field(Storage::Auto);
        EXPECT_EQ(field.storage(), Storage::Float);
        EXPECT_EQ(field.voxel({3, 1, 1}), odd);
    }
}

TEST(Field, HalfRefusesWhatItCannotHoldAndRoundsTheRest) {
    PlainGrid grid;
    grid.setLeaf({0, 0, 0}, [](Vec3i v, int) { return v.x == 3 ? 70000.0f : 0.1f; });
    expectError(ErrorKind::Input, "65504", [&] { grid.field(Storage::Half); });
    PlainGrid small;
    small.setLeaf({0, 0, 0}, [](Vec3i v, int) { return 0.1f * static_cast<float>(v.x + 1); });
    const Field field = small.field(Storage::Half);
    for (int x = 0; x < 8; ++x)
        EXPECT_NEAR(field.voxel({x, 0, 0}), 0.1 * (x + 1), 0.1 * (x + 1) * 0x1p-11);
}

TEST(Field, TrilinearIsTheSumOfEightWeightedVoxels) {
    for (const PlainGrid& grid : grids()) {
        const Field field = grid.field();
        for (Vec3d p : points(grid, 300, 3))
            for (int c = 0; c < grid.channels(); ++c)
                ASSERT_NEAR(field.trilinear(p, c), grid.trilinear(p, c), 1e-7);
    }
}

TEST(Field, TrilinearReproducesLinearFunctions) {
    PlainGrid grid;
    const auto plane = [](auto v) { return 3 * v.x - 2 * v.y + 5 * v.z + 7; };
    for (int i = 0; i < 8; ++i)
        grid.setLeaf({(i & 1) * 8 - 8, (i & 2) * 4 - 8, (i & 4) * 2 - 8},
                     [&](Vec3i v, int) { return static_cast<float>(plane(v)); });
    const Field field = grid.field(Storage::Auto);
    EXPECT_EQ(field.storage(), Storage::Half);
    RandomStream random(4);
    for (int i = 0; i < 2000; ++i) {  // coordinates of ten binary places: no rounding anywhere
        Vec3d p = pointIn({{-8, -8, -8}, {7, 7, 7}}, random) * 1024;
        p = Vec3d{std::floor(p.x), std::floor(p.y), std::floor(p.z)} / 1024;
        ASSERT_EQ(field.trilinear(p), plane(p));
    }
}

TEST(Field, OneTapHasTheMeanOfTrilinear) {
    for (const PlainGrid& grid : {mixedGrid(1), mixedGrid(4, 3, haze)}) {
        const Field field = grid.field();
        RandomStream random(5);
        for (Vec3d p : points(grid, 2, 6)) {
            std::array<Moments, 3> taps;
            for (int i = 0; i < 4000; ++i) {
                const std::uint64_t bits = random.bits();
                for (int c = 0; c < grid.channels(); ++c)
                    taps[static_cast<std::size_t>(c)].add(field.stochastic(p, bits, c));
            }
            for (int c = 0; c < grid.channels(); ++c)
                expectMean(taps[static_cast<std::size_t>(c)], grid.trilinear(p, c), 0.01,
                           "one tap");
        }
    }
}

TEST(Field, OneTapAtAVoxelIsThatVoxel) {
    const PlainGrid grid = mixedGrid(1);
    const Field field = grid.field();
    for (std::uint64_t bits : {std::uint64_t{0}, ~std::uint64_t{0}, hashOf(1)})
        for (Vec3i v : {Vec3i{-9, 3, -1}, Vec3i{0, 0, 0}, Vec3i{7, -8, -16}})
            EXPECT_EQ(field.stochasticVoxel(v.as<double>(), bits), v);
}

/// A solid ball of leaves, as volumes are.
PlainGrid ball(int leaves) {
    PlainGrid grid;
    for (int i = 0; i < leaves * leaves * leaves; ++i) {
        const Vec3i b{i % leaves, i / leaves % leaves, i / leaves / leaves};
        const Vec3i d = b * 2 - Vec3i{1, 1, 1} * (leaves - 1);
        if (dot(d, d) <= leaves * leaves)
            grid.setLeaf(b * 8, [](Vec3i v, int) {
                return static_cast<float>((v.x * 5 + v.y * 3 + v.z) & 31);
            });
    }
    return grid;
}

TEST(Field, CostsNoMoreThanOpenVdbAndHalfThreeQuartersOfIt) {
    const PlainGrid grid = ball(24);
    const double leaf = 2048 + 96;  // voxels, and the mask and origin of an OpenVDB leaf
    const double tree = leaf * static_cast<double>(grid.leaves().size());
    EXPECT_LE(static_cast<double>(grid.field(Storage::Float).bytes()), tree);
    EXPECT_LE(static_cast<double>(grid.field(Storage::Half).bytes()), 0.75 * tree);
    EXPECT_LE(static_cast<double>(grid.field(Storage::Auto).bytes()), 0.75 * tree);
}

TEST(Field, AHugeTileCostsLittle) {
    PlainGrid grid;
    grid.setTile({-4096, 0, 4096}, 4096, {1});
    grid.setTile({0, 0, 4096}, 4096, {1});
    const Field field = grid.field();
    EXPECT_LT(field.bytes(), 4096u);
    EXPECT_EQ(field.support(), (Box3d{{-4097, -1, 4095}, {4096, 4096, 8192}}));
}

}  // namespace
}  // namespace woodcock::test
