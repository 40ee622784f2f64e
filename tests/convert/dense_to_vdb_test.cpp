// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/dense_to_vdb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/expect_error.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace convert;
using namespace grid;

namespace {

DenseVolume dense(const Dims& dims, int channels, std::vector<float> numbers) {
    DenseVolume volume;
    volume.dims = dims;
    volume.channels = channels;
    volume.setStridesXFirst();
    auto values = std::make_shared<std::vector<float>>(std::move(numbers));
    volume.samples = reinterpret_cast<const char*>(values->data());
    volume.owner = values;
    return volume;
}

/// Random numbers, most of them zero, in blocks that are no multiple of a leaf.
std::vector<float> sparseNumbers(std::size_t n) {
    std::mt19937 random(1);
    std::vector<float> values(n);
    for (std::size_t i = 0; i < n; ++i)
        if (i / 300 % 3 == 0) values[i] = static_cast<float>(random() % 1000) / 7.0f - 30;
    return values;
}

template <class GridT>
const GridT& only(const VdbGrids& grids) {
    return dynamic_cast<const GridT&>(*grids.grids.at(0));
}

TEST(DenseToVdb, HoldsEveryNumberAndNoMore) {
    const Dims dims{21, 16, 35};
    const std::vector<float> numbers = sparseNumbers(21 * 16 * 35);
    DenseVolume volume = dense(dims, 1, numbers);
    volume.worldFromIndex = Affine3d::translate({1, 2, 3}) * Affine3d::scale({0.1, 0.2, 0.3});
    ValueSummary found;
    const VdbGrids grids = denseToVdb(volume, {}, found);
    const auto& grid = only<openvdb::FloatGrid>(grids);
    EXPECT_EQ(grid.getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(grid.getName(), "density");
    std::uint64_t active = 0;
    for (int z = 0; z < 35; ++z)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 21; ++x) {
                const float v = numbers[static_cast<std::size_t>(x + 21 * (y + 16 * z))];
                EXPECT_EQ(grid.tree().getValue({x, y, z}), v);
                EXPECT_EQ(grid.tree().isValueOn({x, y, z}), v != 0);
                active += v != 0;
            }
    EXPECT_EQ(grid.activeVoxelCount(), active);
    EXPECT_EQ(found.active, active);
    EXPECT_EQ(found.min, double(*std::min_element(numbers.begin(), numbers.end())));
    const openvdb::Vec3d at = grid.indexToWorld(openvdb::Vec3d(20, 15, 34));
    EXPECT_DOUBLE_EQ(at[0], 1 + 20 * 0.1);
    EXPECT_DOUBLE_EQ(at[2], 3 + 34 * 0.3);

    const DenseVolume back = vdbToDense(grids, 0, Box3i{{0, 0, 0}, {20, 15, 34}});
    EXPECT_EQ(std::memcmp(back.samples, numbers.data(), numbers.size() * sizeof(float)), 0);
    EXPECT_EQ(back.worldFromIndex, volume.worldFromIndex);
}

TEST(DenseToVdb, MakesTilesOfConstantLeaves) {
    ValueSummary found;
    const VdbGrids grids =
        denseToVdb(dense({16, 16, 16}, 1, std::vector<float>(4096, 2.0f)), {}, found);
    EXPECT_EQ(only<openvdb::FloatGrid>(grids).tree().leafCount(), 0u);
    EXPECT_EQ(grids.grids[0]->activeVoxelCount(), 4096u);
    const DenseVolume back = vdbToDense(grids, 0);
    EXPECT_EQ(back.dims, (Dims{16, 16, 16}));
}

TEST(DenseToVdb, MakesVectorsOfThreeChannels) {
    ValueSummary found;
    const VdbGrids grids = denseToVdb(dense({2, 1, 1}, 3, {0, 0, 0, 1, 2, 3}), {}, found);
    const auto& grid = only<openvdb::Vec3SGrid>(grids);
    EXPECT_EQ(grid.activeVoxelCount(), 1u);
    EXPECT_EQ(grid.tree().getValue({1, 0, 0}), openvdb::Vec3s(1, 2, 3));
    expectError(ErrorKind::Input, "--channel", [&] {
        denseToVdb(dense({1, 1, 1}, 2, {1, 2}), {}, found);
    });
}

TEST(DenseToVdb, RemapsInTheOrderItSays) {
    ValueSummary found;
    ValueOptions options;
    options.remap = {.scale = 2, .offset = 1, .low = -1, .high = 5, .threshold = 0.5};
    const VdbGrids grids = denseToVdb(dense({1, 1, 5}, 1, {-4, -0.3f, 0, 1, 8}), options, found);
    const auto& tree = only<openvdb::FloatGrid>(grids).tree();
    // 2 v + 1 = -7, 0.4, 1, 3, 17; then within [-1, 5]; then zero below 0.5.
    const float expected[]{0, 0, 1, 3, 5};
    for (int z = 0; z < 5; ++z) EXPECT_EQ(tree.getValue({0, 0, z}), expected[z]) << z;
    EXPECT_EQ(grids.grids[0]->activeVoxelCount(), 3u);
    options = {.tolerance = 0.5};
    EXPECT_EQ(denseToVdb(dense({1, 1, 4}, 1, {-0.5f, 0.5f, 0.6f, -0.6f}), options, found)
                  .grids[0]
                  ->activeVoxelCount(),
              2u);
}

TEST(DenseToVdb, CountsWhatIsNotFinite) {
    const float inf = std::numeric_limits<float>::infinity();
    std::vector<float> numbers(20 * 20 * 20, 1.0f);
    numbers[5 + 20 * (6 + 20 * 7)] = NAN;
    numbers[4 + 20 * (9 + 20 * 9)] = NAN;
    numbers[1] = -inf;
    ValueSummary found;
    const VdbGrids grids = denseToVdb(dense({20, 20, 20}, 1, numbers), {}, found);
    EXPECT_EQ(grids.grids[0]->activeVoxelCount(), 8000u - 3);
    expectError(ErrorKind::Input,
                "2 NaN voxels (first at [4, 9, 9]), 1 infinite voxel (first at "
                "[1, 0, 0])",
                [&] { requireSound(found, "a", false); });
    EXPECT_NE(requireSound(found, "a", true), "");
    ValueOptions huge;
    huge.remap.scale = 1e39;
    denseToVdb(dense({1, 1, 1}, 1, {1}), huge, found);
    expectError(ErrorKind::Input, "1 infinite voxel", [&] { requireSound(found, "a", true); });
}

TEST(VdbToDense, RefusesEmptyAndEndlessGrids) {
    openvdb::initialize();
    VdbGrids grids{{openvdb::FloatGrid::create()}};
    expectError(ErrorKind::Input, "empty", [&] { vdbToDense(grids, 0); });
    auto far = openvdb::FloatGrid::create();
    far->tree().setValue({-2000000000, 0, 0}, 1.0f);
    far->tree().setValue({2000000000, 2000000000, 0}, 1.0f);
    expectError(ErrorKind::Input, "--bounds", [&] { vdbToDense({{far}}, 0); });
}

TEST(Precision, StatesTheErrorOfHalves) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create();
    // 1 + 2^-12 lies 2^-12 above the half 1; 2049 between 2048 and 2050.
    grid->tree().setValue({0, 0, 0}, 1 + std::ldexp(1.0f, -12));
    grid->tree().setValue({0, 0, 1}, 2049.0f);
    VdbGrids grids{{grid}};
    const PrecisionLoss loss = setPrecision(grids, Precision::Half);
    EXPECT_EQ(loss.absolute, 1);
    EXPECT_DOUBLE_EQ(loss.relative, 1 / 2049.0);
    grid->tree().setValue({0, 0, 2}, 65520.0f);  // the least that is rounded to infinity
    expectError(ErrorKind::Input, "[0, 0, 2]", [&] { setPrecision(grids, Precision::Half); });
    grid->tree().setValue({0, 0, 2}, 65519.0f);
    EXPECT_EQ(setPrecision(grids, Precision::Half).absolute, 15);
}

TEST(Precision, TurnsDoublesToFloats) {
    openvdb::initialize();
    auto grid = openvdb::DoubleGrid::create(0.5);
    grid->setName("heat");
    grid->tree().setValue({0, 0, 0}, 1 + std::ldexp(1.0, -25));
    VdbGrids grids{{grid}};
    EXPECT_EQ(setPrecision(grids, Precision::Float).absolute, std::ldexp(1.0, -25));
    const auto& floats = only<openvdb::FloatGrid>(grids);
    EXPECT_EQ(floats.getName(), "heat");
    EXPECT_EQ(floats.background(), 0.5f);
    EXPECT_EQ(floats.tree().getValue({0, 0, 0}), 1.0f);
    setPrecision(grids, Precision::Double);
    EXPECT_EQ(only<openvdb::DoubleGrid>(grids).tree().getValue({0, 0, 0}), 1.0);
}

/// Each pair of types that OpenVDB cannot turn into each other too: tiles, background, inactive
/// values and transform stay, and the error is that of rounding.
TEST(Precision, TurnsVectorsOfAnyType) {
    openvdb::initialize();
    using openvdb::Vec3d, openvdb::Vec3f, openvdb::Vec3i;
    auto doubles = openvdb::Vec3DGrid::create(Vec3d(0.1, 0, 0));
    doubles->setName("vel");
    doubles->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    doubles->tree().setValueOn({1, 2, 3}, Vec3d(1 + std::ldexp(1.0, -25), 2, -3));
    doubles->tree().setValueOff({1, 2, 4}, Vec3d(4, 5, 6));
    doubles->tree().addTile(2, {256, 0, 0}, Vec3d(7, 8, 9), true);
    doubles->tree().addTile(1, {-64, 0, 0}, Vec3d(-1, 0, 1), false);
    VdbGrids grids{{doubles}};
    const PrecisionLoss loss = setPrecision(grids, Precision::Float);
    EXPECT_EQ(loss.absolute, std::ldexp(1.0, -25));
    const auto& floats = only<openvdb::Vec3SGrid>(grids);
    EXPECT_EQ(floats.getName(), "vel");
    EXPECT_EQ(floats.voxelSize(), Vec3d(0.25));
    EXPECT_EQ(floats.background(), Vec3f(0.1f, 0, 0));
    EXPECT_TRUE(floats.tree().hasSameTopology(doubles->tree()));
    EXPECT_EQ(floats.tree().getValue({1, 2, 3}), Vec3f(1, 2, -3));
    EXPECT_EQ(floats.tree().getValue({1, 2, 4}), Vec3f(4, 5, 6));
    EXPECT_FALSE(floats.tree().isValueOn({1, 2, 4}));
    EXPECT_EQ(floats.tree().getValue({300, 5, 6}), Vec3f(7, 8, 9));
    EXPECT_EQ(floats.tree().getValue({-60, 1, 1}), Vec3f(-1, 0, 1));
    EXPECT_FALSE(floats.tree().isValueOn({-60, 1, 1}));

    auto whole = openvdb::Vec3IGrid::create(Vec3i(0, 0, 1));
    whole->tree().setValueOn({0, 0, 0}, Vec3i(1, -2, 2147483647));
    VdbGrids wholes{{whole}};
    EXPECT_EQ(useFloatingPoint(wholes), 0);
    const auto& exact = only<openvdb::Vec3DGrid>(wholes).tree();
    EXPECT_EQ(exact.getValue({0, 0, 0}), Vec3d(1, -2, 2147483647));
    EXPECT_EQ(exact.background(), Vec3d(0, 0, 1));
}

TEST(Precision, StatesWhatDoublesCannotHoldOfWholeNumbers) {
    openvdb::initialize();
    auto grid = openvdb::Int64Grid::create();
    grid->tree().setValueOn({0, 0, 0}, (std::int64_t{1} << 53) + 1);
    grid->tree().setValueOn({0, 0, 1}, -(std::int64_t{1} << 54));
    VdbGrids grids{{grid}};
    EXPECT_EQ(useFloatingPoint(grids), 1);
    EXPECT_EQ(only<openvdb::DoubleGrid>(grids).tree().getValue({0, 0, 1}), -std::ldexp(1.0, 54));
    auto largest = openvdb::Int64Grid::create();
    largest->tree().setValueOn({0, 0, 0}, std::numeric_limits<std::int64_t>::max());
    VdbGrids rounded{{largest}};
    EXPECT_EQ(useFloatingPoint(rounded), 1);
}

TEST(RemapGrids, TouchesActiveValuesOnly) {
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create();
    grid->tree().setValueOn({0, 0, 0}, 1.0f);
    grid->tree().setValueOn({0, 0, 1}, 0.1f);
    grid->tree().setValueOff({0, 0, 2}, 7.0f);
    grid->tree().addTile(1, {64, 0, 0}, 2.0f, true);
    VdbGrids grids{{grid}};
    ValueSummary found;
    remapGrids(grids, {.remap = {.scale = 3, .threshold = 1}}, found);
    EXPECT_EQ(grid->tree().getValue({0, 0, 0}), 3);
    EXPECT_EQ(grid->tree().getValue({0, 0, 1}), 0);
    EXPECT_FALSE(grid->tree().isValueOn({0, 0, 1}));
    EXPECT_EQ(grid->tree().getValue({0, 0, 2}), 7);
    EXPECT_EQ(grid->tree().getValue({65, 1, 1}), 6);
    EXPECT_EQ(grid->activeVoxelCount(), 1u + 512);
}

}  // namespace
}  // namespace woodcock::test
