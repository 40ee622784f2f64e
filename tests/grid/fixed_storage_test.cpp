// SPDX-License-Identifier: Apache-2.0
// Voxels as integers of 16 or 8 bits: how far they are from what they stand for, and that all
// bounds are those of what is stored.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "tests/medium/media.h"
#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/base/random.h"
#include "woodcock/grid/block_ranges.h"
#include "woodcock/grid/majorants.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/support/plain_grid.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace medium;
using namespace proof;

namespace {

constexpr Storage fixedStorages[] = {Storage::Fixed16, Storage::Fixed8};

double lastCode(Storage storage) { return storage == Storage::Fixed16 ? 65535 : 255; }

/// From 0 to 1.
float unit(std::uint64_t seed, Vec3i v, int channel) {
    return static_cast<float>(hashOf(seed, v.x, v.y, v.z, channel) >> 40) * 0x1p-24f;
}

using Brick = std::function<float(Vec3i, int)>;

/// Never negative.
const std::vector<Brick> hostileBricks{
    [](Vec3i v, int c) { return unit(1, v, c); },
    [](Vec3i v, int c) { return 0.1f + 1e-7f * unit(2, v, c); },
    [](Vec3i v, int c) { return std::pow(10.0f, 12 * unit(3, v, c) - 6); },
    [](Vec3i v, int c) { return 1e-43f * unit(4, v, c); },  // denormal, and so is a step
    [](Vec3i v, int c) { return 1e-38f * unit(5, v, c); },
    [](Vec3i v, int c) { return v.x == 3 ? 65504.0f : unit(6, v, c); },
    [](Vec3i v, int) {
        return v == Vec3i{1, 2, 3} ? 0.7f : 0.0f;
    },
    [](Vec3i v, int c) { return FLT_MAX * unit(7, v, c); },
    [](Vec3i v, int) { return v.z & 1 ? FLT_MAX : 0.0f; },
    [](Vec3i, int c) { return 0.3f + static_cast<float>(c); },
    [](Vec3i v, int c) { return c == 1 ? 0.25f : 1e6f * unit(8, v, c); },
    [](Vec3i, int) { return FLT_MAX; }};

/// Brick `i` of `bricks` from voxel [16 i, 0, 0] on.
PlainGrid gridOf(const std::vector<Brick>& bricks, int channels) {
    PlainGrid grid(channels);
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        const Vec3i origin{16 * static_cast<int>(i), 0, 0};
        grid.setLeaf(origin, [&](Vec3i v, int c) { return bricks[i](v - origin, c); });
    }
    return grid;
}

Range rangeOf(const PlainGrid& grid, Vec3i leaf, int channel) {
    Range r{grid.voxel(leaf, channel), grid.voxel(leaf, channel)};
    for (int i = 0; i < 512; ++i) {
        const float v = grid.voxel(leaf + Vec3i{i >> 6, i >> 3 & 7, i & 7}, channel);
        r.add({v, v});
    }
    return r;
}

/// Calls f(stored, exact) for all voxels of a leaf.
template <class F>
void forEachVoxel(const Field& field, const PlainGrid& grid, Vec3i leaf, int channel, F&& f) {
    for (int i = 0; i < 512; ++i) {
        const Vec3i v = leaf + Vec3i{i >> 6, i >> 3 & 7, i & 7};
        f(field.voxel(v, channel), grid.voxel(v, channel));
    }
}

TEST(FixedStorage, ErrsByHalfAStepAndStaysInTheRange) {
    for (int channels : {1, 3})
        for (Storage storage : fixedStorages) {
            const PlainGrid grid = gridOf(hostileBricks, channels);
            const Field field = grid.field(storage);
            EXPECT_EQ(field.storage(), storage);
            double worst = 0;
            for (Vec3i leaf : grid.leaves())
                for (int c = 0; c < channels; ++c) {
                    SCOPED_TRACE(testing::Message() << leaf.x / 16 << " channel " << c << " of "
                                                    << channels << " " << storageName(storage));
                    const Range r = rangeOf(grid, leaf, c);
                    const double bound = 0.5 * (double{r.max} - r.min) / lastCode(storage) +
                                         0x1p-23 * double{r.max} + 1e-40;
                    forEachVoxel(field, grid, leaf, c, [&](float stored, float exact) {
                        const double error = std::abs(double{stored} - exact);
                        ASSERT_LE(error, bound);
                        ASSERT_GE(stored, r.min);
                        ASSERT_LE(stored, r.max);
                        if (exact == r.min) {  // zero, constants
                            ASSERT_EQ(stored, exact);
                        }
                        worst = std::max(worst, error);
                    });
                }
            EXPECT_EQ(field.largestFixedError(), static_cast<float>(worst));
            EXPECT_GT(worst, 0);
        }
}

TEST(FixedStorage, KeepsZeroWhereSignsDiffer) {
    const std::vector<Brick> bricks{
        [](Vec3i v, int c) { return v.x == 2 ? 0.0f : unit(1, v, c) - 0.013f; },
        [](Vec3i v, int c) { return v.x == 2 ? 0.0f : 1e6f * (unit(2, v, c) - 0.9f); },
        [](Vec3i v, int c) { return v.x == 2 ? 0.0f : -unit(3, v, c); },
        [](Vec3i v, int) { return static_cast<float>(v.x == 2 ? 0 : v.x - 7); },
        [](Vec3i v, int c) { return v.x == 2 ? 0.0f : 1e-38f * (unit(4, v, c) - 0.5f); }};
    for (Storage storage : fixedStorages) {
        const PlainGrid grid = gridOf(bricks, 3);
        const Field field = grid.field(storage);
        for (Vec3i leaf : grid.leaves())
            for (int c = 0; c < 3; ++c) {
                const Range r = rangeOf(grid, leaf, c);
                const double step = (double{r.max} - r.min) / (lastCode(storage) - 1);
                forEachVoxel(field, grid, leaf, c, [&](float stored, float exact) {
                    ASSERT_NEAR(stored, exact, 0.5 * 1.01 * step + 1e-38) << leaf.x / 16;
                    if (exact == 0) {
                        ASSERT_EQ(stored, 0);
                    }
                });
            }
    }
    PlainGrid wide;
    wide.setLeaf({0, 0, 0}, [](Vec3i v, int) { return v.x & 1 ? FLT_MAX : -FLT_MAX; });
    expectError(ErrorKind::Input, "use float storage", [&] { wide.field(Storage::Fixed8); });
}

/// Table kinds, channels and backgrounds; values of mixedGrid() are multiples of 1/1024.
std::vector<PlainGrid> grids() {
    return {mixedGrid(1), mixedGrid(4, 3, haze), scatteredGrid(5), scatteredGrid(8, 3, haze),
            gridOf(hostileBricks, 3)};
}

TEST(FixedStorage, RangesAreThoseOfStoredValues) {
    for (const PlainGrid& grid : grids())
        for (Storage storage : fixedStorages) {
            const Field field = grid.field(storage);
            Range all{field.background(), field.background()};
            for (Vec3i leaf : grid.leaves()) {
                const std::uint32_t ref =
                    *field.blocks().find({leaf.x >> 3, leaf.y >> 3, leaf.z >> 3}).value;
                Range found{field.voxel(leaf), field.voxel(leaf)};
                for (int c = 0; c < grid.channels(); ++c)
                    forEachVoxel(field, grid, leaf, c, [&](float stored, float) {
                        found.add({stored, stored});
                    });
                ASSERT_EQ(field.storedRange(ref), found);
                ASSERT_EQ(field.storedRange(ref, {8, 8, 8}), found);
                all.add(found);
            }
            EXPECT_LE(field.range().min, all.min);
            EXPECT_GE(field.range().max, all.max);
        }
}

TEST(FixedStorage, MajorantsBoundTheReconstruction) {
    for (const PlainGrid& grid : {mixedGrid(1), mixedGrid(4, 3, haze), gridOf(hostileBricks, 3)})
        for (Storage storage : fixedStorages) {
            const Field field = grid.field(storage);
            const MajorantGrid majorants(field, {10, 1, 1});
            RandomStream random(3);
            for (Vec3i leaf : grid.leaves())
                for (int i = 0; i < 200; ++i) {
                    const Vec3d p = leaf.as<double>() + Vec3d{random.uniform() * 10 - 1,
                                                              random.uniform() * 10 - 1,
                                                              random.uniform() * 10 - 1};
                    const Range bounds = majorants.find(floorToInt(p)).range;
                    const std::uint64_t bits = random.bits();
                    for (int c = 0; c < grid.channels(); ++c) {
                        ASSERT_GE(field.stochastic(p, bits, c), bounds.min);
                        ASSERT_LE(field.stochastic(p, bits, c), bounds.max);
                        ASSERT_GE(field.trilinear(p, c), bounds.min * (1 - 1e-6f));
                        ASSERT_LE(field.trilinear(p, c), bounds.max * (1 + 1e-6));
                    }
                }
        }
}

/// Every finite difference in optical depth is at most the stated error times the way.
TEST(FixedStorage, TransmittanceDiffersByNoMoreThanTheErrorImplies) {
    const PlainMedium plain({{.grid = mixedGrid(1), .worldFromIndex = awkwardTransform()}});
    const Medium exact = plain.medium();
    for (Storage storage : fixedStorages) {
        const Medium fixed = plain.medium(1, 1, storage);
        const double error = fixed.parts[0].field()->largestFixedError();
        EXPECT_NEAR(error, 0.5 / lastCode(storage), 0.01 / lastCode(storage));
        double largest = 0;
        for (const TestRay& ray : testRays(exact, 200, 5)) {
            const double difference =
                exactOpticalDepth(fixed, ray.origin, ray.direction, 0, ray.tMax)[0] -
                exactOpticalDepth(exact, ray.origin, ray.direction, 0, ray.tMax)[0];
            EXPECT_LE(std::abs(difference), error * ray.tMax + 1e-5);
            largest = std::max(largest, std::abs(difference));
        }
        EXPECT_GT(largest, 0);
    }
}

TEST(FixedStorage, TakesAQuarterAndAHalfOfFloats) {
    const auto teapot = sharedDir() / "assets" / "teapot_cloud.vdb";
    if (!std::filesystem::exists(teapot)) GTEST_SKIP() << "no " << teapot;
    const auto bytes = [&](Storage storage) {
        return static_cast<double>(loadGrid(teapot, "density", {.storage = storage}).field.bytes());
    };
    const double whole = bytes(Storage::Float);
    EXPECT_LT(bytes(Storage::Fixed16) / whole, 0.52);
    EXPECT_LT(bytes(Storage::Fixed8) / whole, 0.28);
}

TEST(FixedStorage, LoadingStatesTheError) {
    GridSpec grid;
    grid.box = {{0, 0, 0}, {7, 7, 7}};
    grid.value = [](Vec3i v) { return v.x == 0 ? 2 : v.y == 3 ? 1.0 / 255 : 0; };
    const TempDir dir;
    writeVdb(dir / "a.vdb", {grid});
    const auto notes = [&](Storage storage) {
        return loadGrid(dir / "a.vdb", "density", {.storage = storage}).notes;
    };
    // A step is 2/255, and one voxel halfway between two; floats put it below or above.
    const auto stated = notes(Storage::Fixed8);
    ASSERT_EQ(stated.size(), 1u);
    EXPECT_NE(stated[0].find("stored as fixed8: voxels differ by at most 0.00392, 0.2 % of the "
                             "largest"),
              std::string::npos)
        << stated[0];
    EXPECT_TRUE(notes(Storage::Float).empty());
}

}  // namespace
}  // namespace woodcock::test
