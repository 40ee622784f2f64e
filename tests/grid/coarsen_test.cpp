// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/coarsen.h"

#include <gtest/gtest.h>

#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

const std::array<float, 3> haze{0.25f, 0.125f, 0.5f};

/// Coarse voxels in and around all leaves and tiles.
std::vector<Vec3i> coarseVoxels(const PlainGrid& grid) {
    std::vector<Vec3i> voxels;
    const auto around = [&](Vec3i fine, int size) {
        const Vec3i low{(fine.x >> 1) - 1, (fine.y >> 1) - 1, (fine.z >> 1) - 1};
        const int step = size > 8 ? size / 14 : 1;
        for (int x = 0; x < size / 2 + 2; x += step)
            for (int y = 0; y < size / 2 + 2; y += step)
                for (int z = 0; z < size / 2 + 2; z += step) voxels.push_back(low + Vec3i{x, y, z});
    };
    for (Vec3i o : grid.leaves()) around(o, 8);
    for (const FieldTile& t : grid.tiles()) around(t.origin, t.size);
    return voxels;
}

/// Tiles of every size, on both sides of zero; flat and sparse tables; 1 and 3 channels.
TEST(Coarsen, VoxelsAreMeansOfEight) {
    for (const PlainGrid& grid :
         {mixedGrid(1), mixedGrid(4, 3, haze), scatteredGrid(5), scatteredGrid(8, 3, haze)}) {
        const Field coarse = coarsened(grid.field());
        EXPECT_EQ(coarse.channels(), grid.channels());
        for (Vec3i v : coarseVoxels(grid))
            for (int c = 0; c < grid.channels(); ++c) {
                double sum = 0;
                for (int i = 0; i < 8; ++i)
                    sum += grid.voxel(v * 2 + Vec3i{i & 1, i >> 1 & 1, i >> 2}, c);
                ASSERT_EQ(coarse.voxel(v, c), static_cast<float>(sum / 8))
                    << v.x << " " << v.y << " " << v.z;
            }
        for (int c = 0; c < grid.channels(); ++c)
            EXPECT_EQ(coarse.background(c), grid.background(c));
    }
}

/// A voxel counts eight times as much, a level on.
TEST(Coarsen, KeepsTheIntegral) {
    const PlainGrid grid = mixedGrid(2, 3);
    const auto mass = [](const Field& field, int width, int c) {
        double sum = 0;
        for (int x = -width; x < width; ++x)
            for (int y = -width; y < width; ++y)
                for (int z = -width; z < width; ++z) sum += field.voxel({x, y, z}, c);
        return sum;
    };
    const Field fine = grid.field();
    for (int c = 0; c < 3; ++c) {
        const double whole = mass(fine, 32, c);
        ASSERT_GT(whole, 100);
        Field coarse = coarsened(fine);
        EXPECT_NEAR(8 * mass(coarse, 16, c), whole, 1e-7 * whole);
        coarse = coarsened(coarse);
        EXPECT_NEAR(64 * mass(coarse, 8, c), whole, 1e-7 * whole);
    }
}

TEST(Coarsen, RampsStayWhereTheyAre) {
    PlainGrid grid;
    const auto plane = [](auto v) { return 3 * v.x - 2 * v.y + 5 * v.z + 200; };
    for (int i = 0; i < 64; ++i)
        grid.setLeaf(Vec3i{i & 3, i >> 2 & 3, i >> 4} * 8 - Vec3i{16, 16, 16},
                     [&](Vec3i v, int) { return static_cast<float>(plane(v)); });
    const Field once = coarsened(grid.field());
    const Field twice = coarsened(once);
    for (const Vec3d p : {Vec3d{0, 0, 0}, {-5.25, 3.5, 7.75}, {11, -11.5, -2}, {1.5, 1.5, 1.5}}) {
        const Affine3d toCoarse = fineFromCoarse().inverse();
        EXPECT_NEAR(once.trilinear(toCoarse.point(p)), plane(p), 1e-4);
        EXPECT_NEAR(twice.trilinear((toCoarse * toCoarse).point(p)), plane(p), 1e-4);
    }
}

TEST(Coarsen, ConstantsStayConstants) {
    PlainGrid grid(3);
    grid.setTile({0, 0, 0}, 4096, {0.1f, 0.2f, 0.3f});
    grid.setTile({4096, 128, 0}, 128, {0.3f, 0.2f, 0.1f});
    for (int i = 0; i < 8; ++i)
        grid.setTile({-16 + 8 * (i & 1), 8 * (i >> 1 & 1), 8 * (i >> 2)}, 8, {1, 2, 3});
    const Field coarse = coarsened(grid.field());
    EXPECT_EQ(coarse.brickCount(), 0u);
    EXPECT_EQ(coarse.voxel({2047, 0, 5}, 2), 0.3f);
    EXPECT_EQ(coarse.voxel({2048, 64, 0}, 1), 0.2f);
    EXPECT_EQ(coarse.voxel({2111, 127, 63}, 0), 0.3f);
    EXPECT_EQ(coarse.voxel({2112, 127, 63}, 0), 0.0f);
    EXPECT_EQ(coarse.voxel({-1, 7, 7}, 2), 3.0f);
}

TEST(Coarsen, WeightsDecideWhereThereAreAny) {
    PlainGrid colour(3), density;
    colour.setLeaf({0, 0, 0},
                   [](Vec3i v, int c) { return v.x & 1 ? 0.25f * static_cast<float>(c + 1) : 0; });
    density.setLeaf({0, 0, 0}, [](Vec3i v, int) { return v.y > 3 ? 0.0f : v.x & 1 ? 3.0f : 1; });
    const Field weights = density.field();
    const Field coarse = coarsened(colour.field(), &weights);
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(coarse.voxel({1, 1, 1}, c), 0.75f * 0.25f * static_cast<float>(c + 1));
        EXPECT_FLOAT_EQ(coarse.voxel({1, 2, 1}, c), 0.5f * 0.25f * static_cast<float>(c + 1));
    }
}

TEST(Coarsen, KeepsTheLookup) {
    Field field = mixedGrid(1).field(Storage::Fixed8);
    field.setLookup(Lookup::Nearest);
    EXPECT_EQ(coarsened(field).lookup(), Lookup::Nearest);
    EXPECT_EQ(coarsened(field).storage(), Storage::Float);
}

}  // namespace
}  // namespace woodcock::test
