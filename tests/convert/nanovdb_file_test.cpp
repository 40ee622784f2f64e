// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/nanovdb.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/grid/nanovdb/file.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace convert;
using namespace grid;
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

VdbGrids readAll(const std::filesystem::path& path) {
    FileBytes file(path);
    const std::size_t count = readNanoVdbHeads(file).grids.size();
    VdbGrids all;
    for (std::size_t i = 0; i < count; ++i)
        all.grids.push_back(readNanoVdbGrid(path, i).grids.front());
    return all;
}

#define NEEDS_NANOVDB() \
    if (!hasNanoVdb()) GTEST_SKIP() << "this build has no NanoVDB"

/// Dense inside, as tiles, with a shell of voxels of its own, across the origin of the index space.
openvdb::FloatGrid::Ptr ball() {
    const auto grid = openvdb::FloatGrid::create(0.25f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    grid->transform().postTranslate({1.0 / 3, -7, 0.1});
    const int radius = 40;
    auto access = grid->getAccessor();
    for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y)
            for (int z = -radius; z <= radius; ++z) {
                const double r = std::sqrt(x * x + y * y + z * z);
                if (r < radius)
                    access.setValue({x, y, z}, r < 30 ? 1 : static_cast<float>(1 / (r - 29)));
            }
    access.setValueOff({0, 0, radius}, -3.5f);
    grid->pruneGrid();
    return grid;
}

/// Tiles of all sizes, active and not, of values that a comparison of numbers would miss.
openvdb::FloatGrid::Ptr tiles() {
    const auto grid = openvdb::FloatGrid::create(0);
    grid->setName("a name that is longer than the 255 characters of a grid's head " +
                  std::string(300, 'x'));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    openvdb::math::Mat4d turned = openvdb::math::Mat4d::identity();
    turned.setToRotation(openvdb::math::Vec3d(1, 2, 3), 0.7);
    turned.postScale(openvdb::math::Vec3d(0.1, 0.2, 0.3));
    turned.setTranslation({5, 6, 7});
    grid->setTransform(openvdb::math::Transform::createLinearTransform(turned));
    auto& tree = grid->tree();
    const int corner = -(1 << 30);
    tree.addTile(3, {corner, 0, 4096}, 2, true);
    tree.addTile(3, {0, corner, 0}, -2, false);
    tree.addTile(2, {8192, 128, -128}, 3, true);
    tree.addTile(2, {8192, 256, -128}, -0.0f, false);
    tree.addTile(1, {8192, 0, -256}, std::numeric_limits<float>::denorm_min(), true);
    tree.addTile(1, {-4096, 0, 0}, 4, false);  // a node without any active voxel
    tree.setValue({-4096 - 1, -1, -1}, std::numeric_limits<float>::infinity());
    return grid;
}

openvdb::Vec3SGrid::Ptr vectors() {
    const auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0, 1, 2));
    grid->setName("vel");
    grid->setGridClass(openvdb::GRID_STAGGERED);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(
        openvdb::math::Mat4d(1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1)));
    for (int i = -20; i < 20; ++i)
        grid->tree().setValue({i, 2 * i, -300 * i},
                              {static_cast<float>(i), 0.1f * static_cast<float>(i), -1});
    grid->tree().addTile(2, {128, 0, 0}, {-1, -2, -3}, true);
    return grid;
}

std::uint32_t bitsOf(float v) { return std::bit_cast<std::uint32_t>(v); }
std::array<std::uint32_t, 3> bitsOf(const openvdb::Vec3f& v) {
    return {bitsOf(v[0]), bitsOf(v[1]), bitsOf(v[2])};
}

template <class GridT>
void expectSame(const openvdb::GridBase& a, const GridT& b) {
    EXPECT_EQ(a.getName(), b.getName());
    EXPECT_EQ(a.getGridClass(), b.getGridClass());
    EXPECT_EQ(a.transform(), b.transform());
    ASSERT_TRUE(a.isType<GridT>());
    const auto& x = static_cast<const GridT&>(a).tree();
    const auto& y = b.tree();
    EXPECT_EQ(bitsOf(x.background()), bitsOf(y.background()));
    EXPECT_TRUE(x.hasSameTopology(y));
    auto other = y.cbeginValueAll();
    for (auto it = x.cbeginValueAll(); it; ++it, ++other) {
        ASSERT_TRUE(other);
        ASSERT_EQ(it.getCoord(), other.getCoord());
        ASSERT_EQ(it.getLevel(), other.getLevel());
        ASSERT_EQ(it.isValueOn(), other.isValueOn()) << it.getCoord();
        ASSERT_EQ(bitsOf(*it), bitsOf(*other)) << it.getCoord();
    }
    EXPECT_FALSE(other);
}

TEST(NanoVdbFile, KeepsEveryBitOfEveryGrid) {
    NEEDS_NANOVDB();
    const TempDir dir;
    ASSERT_GT(ball()->tree().activeTileCount(), 10u);
    writeNanoVdb(dir / "a.nvdb", {{ball(), tiles(), vectors()}});
    const VdbGrids read = readAll(dir / "a.nvdb");
    ASSERT_EQ(read.grids.size(), 3u);
    expectSame(*read.grids[0], *ball());
    expectSame(*read.grids[1], *tiles());
    expectSame(*read.grids[2], *vectors());
}

TEST(NanoVdbFile, SameGridsGiveSameBytesAndStayAsTheyWere) {
    NEEDS_NANOVDB();
    const TempDir dir;
    const VdbGrids grids{{ball(), tiles(), vectors()}};
    writeNanoVdb(dir / "a.nvdb", grids);
    expectSame(*grids.grids[0], *ball());
    expectSame(*grids.grids[1], *tiles());
    expectSame(*grids.grids[2], *vectors());
    writeNanoVdb(dir / "b.nvdb", {{ball(), tiles(), vectors()}});
    EXPECT_EQ(readText(dir / "a.nvdb"), readText(dir / "b.nvdb"));
}

TEST(NanoVdbFile, EmptyGridsAndThoseWithoutActiveVoxelsAreKept) {
    NEEDS_NANOVDB();
    const TempDir dir;
    const auto empty = openvdb::FloatGrid::create(0.5f);
    const auto inactive = openvdb::FloatGrid::create(0);
    inactive->tree().setValueOff({-5, 700, 9}, 2);
    writeNanoVdb(dir / "a.nvdb", {{empty, inactive}});
    const VdbGrids read = readAll(dir / "a.nvdb");
    ASSERT_EQ(read.grids.size(), 2u);
    expectSame(*read.grids[0], *empty);
    expectSame(*read.grids[1], *inactive);
}

TEST(NanoVdbFile, WhatItCannotKeepIsAnErrorThatNamesTheGrid) {
    NEEDS_NANOVDB();
    const TempDir dir;
    const auto expectBad = [&](const openvdb::GridBase::Ptr& grid, const char* part) {
        grid->setName("odd");
        for (const std::string& expected : {std::string(part), std::string("'odd'")})
            expectError(ErrorKind::Usage, expected, [&] {
                writeNanoVdb(dir / "a.nvdb", {{ball(), grid}});
            });
    };
    expectBad(openvdb::BoolGrid::create(), "holds bool; expected float, double or vec3s");
    expectBad(openvdb::Vec3DGrid::create(), "holds vec3d");
    const auto tapered = openvdb::FloatGrid::create();
    tapered->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd({0, 0, 0}, {1, 1, 1}), 0.5, 1));
    expectBad(tapered, "is not affine");
    const auto level = vectors();
    level->setGridClass(openvdb::GRID_LEVEL_SET);
    expectBad(level, "holds vectors");
    expectError(ErrorKind::Usage, "no grids", [&] { writeNanoVdb(dir / "a.nvdb", {}); });
    EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
    expectError(ErrorKind::Failure, "No such file or directory",
                [&] { writeNanoVdb(dir / "nowhere" / "a.nvdb", {{ball()}}); });
}

TEST(NanoVdbFile, OtherFilesAreErrorsThatNameThem) {
    NEEDS_NANOVDB();
    const TempDir dir;
    const auto expectBad = [&](const std::string& bytes, const std::string& part) {
        writeText(dir / "a.nvdb", bytes);
        expectError(ErrorKind::Input, part, [&] { readAll(dir / "a.nvdb"); });
        expectError(ErrorKind::Input, "a.nvdb", [&] { readAll(dir / "a.nvdb"); });
    };
    expectBad("", "is not a NanoVDB file: it has 0 bytes");
    expectBad("These are words, and more words.", "is not a NanoVDB file");
    expectError(ErrorKind::Input, "missing.nvdb", [&] { readAll(dir / "missing.nvdb"); });

    writeNanoVdb(dir / "good.nvdb", {{ball()}});
    const std::string good = readText(dir / "good.nvdb");
    const auto with = [&](std::size_t place, const std::string& bytes) {
        std::string changed = good;
        changed.replace(place, bytes.size(), bytes);
        return changed;
    };
    const std::size_t entry = 16, grid = good.size() - *reinterpret_cast<const std::uint64_t*>(
                                                           good.data() + entry);
    const std::string huge("\0\0\0\0\0\0\0\x40", 8);
    expectBad(with(0, std::string(good.rbegin() + static_cast<std::ptrdiff_t>(good.size() - 8),
                                  good.rend())),
              "the other byte order");
    expectBad(with(8, std::string("\0\0\x80\x03", 4)), "format 28, where 32 is expected");
    expectBad(with(12, std::string(2, '\0')), "a segment without grids");
    expectBad(with(14, "\x07"), "unknown compression");
    expectBad(with(entry, huge), "cannot unpack to 4611686018427387904");
    expectBad(with(14, std::string("\x02", 1)).replace(entry, 8, huge), "cannot unpack to");
    expectBad(with(entry + 8, huge), "bytes where");
    expectBad(with(grid, "x"), "does not begin with 'NanoVDB0'");
    expectBad(with(grid + 636, "\x08"), "grid 'density' holds mask");
    expectBad(with(grid + 636, "\x63"), "holds unknown type 99");
    expectBad(with(grid + 300, "\x63"), "the checksum of its head is wrong");
    expectBad(with(good.size() - 5, "\x63"), "the checksum of its nodes is wrong");
    expectBad(good + "more", "the header of a segment");
    expectBad(good + std::string(16, 'x'), "no segment begins at byte");
}

TEST(NanoVdbFile, CompressedAndDoublesAreTheSameNumbers) {
    NEEDS_NANOVDB();
    const TempDir dir;
    const auto doubles = openvdb::DoubleGrid::create(0.1);
    doubles->setName("exact");
    doubles->tree().setValue({1, -2, 3}, 1.0 / 3);
    std::size_t plain = 0;
    for (const auto compression :
         {NanoVdbCompression::None, NanoVdbCompression::Zip, NanoVdbCompression::Blosc}) {
        writeNanoVdb(dir / "a.nvdb", {{ball(), vectors(), doubles}}, {.compression = compression});
        const std::size_t bytes = std::filesystem::file_size(dir / "a.nvdb");
        if (compression == NanoVdbCompression::None)
            plain = bytes;
        else
            EXPECT_LT(bytes, plain / 10);
        const VdbGrids read = readAll(dir / "a.nvdb");
        expectSame(*read.grids[0], *ball());
        expectSame(*read.grids[1], *vectors());
        ASSERT_TRUE(read.grids[2]->isType<openvdb::DoubleGrid>());
        const auto& tree = static_cast<const openvdb::DoubleGrid&>(*read.grids[2]).tree();
        EXPECT_EQ(tree.background(), 0.1);
        EXPECT_EQ(tree.getValue({1, -2, 3}), 1.0 / 3);
    }
}

/// Each leaf has 65536 steps between its extremes; a value is off by half of one at most.
TEST(NanoVdbFile, QuantisingStatesItsError) {
    NEEDS_NANOVDB();
    const TempDir dir;
    const auto grid = openvdb::FloatGrid::create(0);
    for (int i = 0; i < 512; ++i)
        grid->tree().setValue({i >> 6, i >> 3 & 7, i & 7}, static_cast<float>(i * i) / 3);
    const NanoVdbLoss loss = writeNanoVdb(dir / "a.nvdb", {{grid}}, {.quantise = true});
    const VdbGrids read = readAll(dir / "a.nvdb");
    const auto& tree = static_cast<const openvdb::FloatGrid&>(*read.grids[0]).tree();
    double most = 0;
    for (auto it = grid->cbeginValueOn(); it; ++it)
        most = std::max(most, std::abs(static_cast<double>(tree.getValue(it.getCoord())) - *it));
    const double step = 511.0 * 511 / 3 / 65535;
    EXPECT_EQ(loss.absolute, most);
    EXPECT_LE(loss.absolute, step * 0.51);
    EXPECT_GT(loss.absolute, step * 0.4);
}

/// A file is a volume as a VDB is: by its usual names, each codec, numbers bit for bit.
TEST(NanoVdbFile, IsListedAndLoadedAsAVdbIs) {
    NEEDS_NANOVDB();
    const TempDir dir;
    const auto second = ball();
    second->setTransform(openvdb::math::Transform::createLinearTransform(2));
    const auto unnamed = vectors();
    unnamed->setName("");
    for (const auto compression :
         {NanoVdbCompression::None, NanoVdbCompression::Zip, NanoVdbCompression::Blosc}) {
        // Known by what it holds, whatever its name says.
        writeNanoVdb(dir / "a.vdb", {{ball(), second, unnamed}}, {.compression = compression});
        const VdbFile listed = listGrids(dir / "a.vdb");
        EXPECT_TRUE(listed.nanoVdb);
        EXPECT_EQ(listed.version, "NanoVDB 32.4");
        EXPECT_EQ(describeGrids(listed), "density[0] (float), density[1] (float), [0] (vec3s)");
        EXPECT_EQ(listed.grids[1].voxelSize, (Vec3d{2, 2, 2}));
        EXPECT_EQ(listed.grids[2].gridClass, GridClass::Staggered);
        const LoadedGrid loaded = loadGrid(dir / "a.vdb", "density[0]", {.nonNegative = false});
        const auto truth = ball();
        EXPECT_EQ(loaded.statistics.voxels.active, truth->activeVoxelCount());
        for (int i = -45; i < 45; ++i)
            ASSERT_EQ(loaded.field.trilinear({double(i), 1, -2}, 0),
                      truth->tree().getValue({i, 1, -2}));
        EXPECT_EQ(loaded.worldFromIndex.point({1, 0, 0}).x,
                  truth->indexToWorld(Coord(1, 0, 0)).x());
        expectError(ErrorKind::Input, "it has: density[0] (float)",
                    [&] { loadGrid(dir / "a.vdb", "heat"); });
    }
}

}  // namespace
}  // namespace woodcock::test
