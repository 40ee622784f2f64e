// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#ifdef WOODCOCK_WITH_NANOVDB
#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/base/error.h"
#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/convert/formats/nanovdb.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/grid/nanovdb/file.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/openvdb_grids.h"

namespace woodcock::test {

using namespace convert;
using namespace grid;
namespace {

using Handle = nanovdb::GridHandle<nanovdb::HostBuffer>;
using openvdb::Coord;

/// Smooth and noisy leaves, tiles, and both signs of coordinates and values.
openvdb::FloatGrid::Ptr sample() {
    const auto grid = openvdb::FloatGrid::create(0.125f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    RandomStream random(3);
    auto access = grid->getAccessor();
    for (int x = -12; x < 12; ++x)
        for (int y = -20; y < 4; ++y)
            for (int z = 0; z < 24; ++z) {
                const auto smooth = static_cast<float>(std::sin(0.3 * x + 0.2 * y - 0.1 * z));
                access.setValue({x, y, z}, z < 8 ? smooth : static_cast<float>(random.uniform()));
            }
    grid->tree().addTile(1, {-32, -8, 8}, 0.5f, true);
    grid->tree().addTile(2, {256, 0, 0}, 0.75f, true);
    return grid;
}

template <class BuildT>
Handle quantised(const openvdb::FloatGrid& grid,
                 nanovdb::ChecksumMode checksum = nanovdb::ChecksumMode::Full) {
    return nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, BuildT>(
        grid, nanovdb::StatsMode::Default, checksum);
}

void write(const std::filesystem::path& file, Handle handle,
           nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
    nanovdb::io::writeGrid(file.string(), handle, codec);
}

VdbGrids readAll(const std::filesystem::path& path) {
    FileBytes file(path);
    const std::size_t count = readNanoVdbHeads(file).grids.size();
    VdbGrids all;
    for (std::size_t i = 0; i < count; ++i)
        all.grids.push_back(readNanoVdbGrid(path, i).grids.front());
    return all;
}

openvdb::FloatGrid::Ptr readOne(const std::filesystem::path& file) {
    return openvdb::gridPtrCast<openvdb::FloatGrid>(readAll(file).grids.at(0));
}

Coord near(RandomStream& random, int reach) {
    const auto draw = [&] { return static_cast<int>(random.bits() % (2 * reach)) - reach; };
    return {draw(), draw(), draw()};
}

TEST(NanoVdbPeer, NanoVdbItselfReadsWhatWeWrite) {
    const TempDir dir;
    const openvdb::FloatGrid::Ptr density = sample();
    const auto sphere =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(20, {3, -5, 300}, 0.5f);
    sphere->setName("surface");
    const auto vectors = openvdb::Vec3SGrid::create(openvdb::Vec3f(1, 2, 3));
    vectors->setName("vel");
    vectors->tree().setValue({-1, -300, 5000}, {4, 5, 6});
    writeNanoVdb(dir / "a.nvdb", {{density, sphere, vectors}});
    const std::string file = (dir / "a.nvdb").string();

    RandomStream random(1);
    const Handle first = nanovdb::io::readGrid(file, 0);
    const nanovdb::FloatGrid* grid = first.grid<float>();
    ASSERT_NE(grid, nullptr);
    EXPECT_STREQ(grid->gridName(), "density");
    EXPECT_TRUE(grid->isFogVolume());
    EXPECT_EQ(grid->activeVoxelCount(), density->activeVoxelCount());
    for (int i = 0; i < 20000; ++i) {
        const Coord at = near(random, i % 2 ? 40 : 600);
        const nanovdb::Coord nano(at.x(), at.y(), at.z());
        ASSERT_EQ(grid->getAccessor().getValue(nano), density->tree().getValue(at)) << at;
        ASSERT_EQ(grid->getAccessor().isActive(nano), density->tree().isValueOn(at)) << at;
    }
    const Handle second = nanovdb::io::readGrid(file, "surface");
    const nanovdb::FloatGrid* surface = second.grid<float>();
    ASSERT_NE(surface, nullptr);
    EXPECT_TRUE(surface->isLevelSet());
    EXPECT_EQ(surface->voxelSize()[0], 0.5);
    const auto box = sphere->evalActiveVoxelBoundingBox();
    EXPECT_EQ(surface->indexBBox().min()[2], box.min().z());
    for (auto it = sphere->cbeginValueOn(); it; ++it) {
        const Coord at = it.getCoord();
        ASSERT_EQ(surface->getAccessor().getValue({at.x(), at.y(), at.z()}), *it);
    }
    const Handle third = nanovdb::io::readGrid(file, 2);
    const nanovdb::Vec3fGrid* vel = third.grid<nanovdb::Vec3f>();
    ASSERT_NE(vel, nullptr);
    EXPECT_EQ(vel->getAccessor().getValue({-1, -300, 5000}), nanovdb::Vec3f(4, 5, 6));
    EXPECT_EQ(vel->getAccessor().getValue({0, 0, 0}), nanovdb::Vec3f(1, 2, 3));
    EXPECT_EQ(nanovdb::GridValidator<float>::check(*grid), "");
    EXPECT_EQ(nanovdb::GridValidator<float>::check(*surface), "");
    EXPECT_EQ(nanovdb::GridValidator<nanovdb::Vec3f>::check(*vel), "");
}

/// Each voxel is the nearest of 2^bits steps between its leaf's least and greatest value.
template <class BuildT>
void expectQuantised(int bits) {
    const TempDir dir;
    const openvdb::FloatGrid::Ptr source = sample();
    const Handle handle = quantised<BuildT>(*source);
    nanovdb::io::writeGrid((dir / "a.nvdb").string(), handle);
    const openvdb::FloatGrid::Ptr read = readOne(dir / "a.nvdb");
    EXPECT_TRUE(read->tree().hasSameTopology(source->tree()));
    const auto truth = handle.template grid<BuildT>()->getAccessor();
    double worst = 0;
    for (auto leaf = source->tree().cbeginLeaf(); leaf; ++leaf) {
        const float* const values = leaf->buffer().data();
        const auto [least, most] = std::minmax_element(values, values + leaf->SIZE);
        const double half = (*most - *least) / std::exp2(bits + 1);
        for (auto it = leaf->cbeginValueAll(); it; ++it) {
            const Coord at = it.getCoord();
            const float found = read->tree().getValue(at);
            ASSERT_EQ(found, truth.getValue({at.x(), at.y(), at.z()})) << at;
            const double error = std::abs(static_cast<double>(found) - *it);
            const double rounding = 3e-7;  // of numbers up to one, each of a few steps
            ASSERT_LE(error, half * std::exp2(bits) / (std::exp2(bits) - 1) + rounding) << at;
            worst = std::max(worst, error / half);
        }
    }
    EXPECT_GT(worst, 0.9);  // or there was nothing to round
}

TEST(NanoVdbPeer, QuantisedGridsAreReadWithinTheirError) {
    expectQuantised<nanovdb::Fp4>(4);
    expectQuantised<nanovdb::Fp8>(8);
    expectQuantised<nanovdb::Fp16>(16);
}

TEST(NanoVdbPeer, GridsOfVariableBitsAreReadWithinTheirTolerance) {
    const TempDir dir;
    const openvdb::FloatGrid::Ptr source = sample();
    nanovdb::OpenToNanoVDB<float, nanovdb::FpN> converter;
    converter.oracle() = nanovdb::AbsDiff(0.002f);
    converter.setChecksum(nanovdb::ChecksumMode::Full);
    const Handle handle = converter(*source);
    nanovdb::io::writeGrid((dir / "a.nvdb").string(), handle);
    const openvdb::FloatGrid::Ptr read = readOne(dir / "a.nvdb");
    const auto truth = handle.grid<nanovdb::FpN>()->getAccessor();
    double worst = 0;
    for (auto it = source->cbeginValueAll(); it; ++it) {
        const Coord at = it.getCoord();
        ASSERT_EQ(read->tree().getValue(at), truth.getValue({at.x(), at.y(), at.z()}));
        worst = std::max(worst, std::abs(static_cast<double>(read->tree().getValue(at)) - *it));
    }
    EXPECT_LE(worst, 0.002f);
    EXPECT_GT(worst, 0.001);
}

TEST(NanoVdbPeer, OtherNumbersStayWhatTheyAre) {
    const TempDir dir;
    const auto doubles = openvdb::DoubleGrid::create(0.1);
    doubles->tree().setValue({1, -2, 3}, 1.0 / 3);
    const auto integers = openvdb::Int32Grid::create(-7);
    integers->tree().setValue({1, -2, 3}, 16777217);
    std::vector<Handle> handles;
    handles.push_back(nanovdb::openToNanoVDB(openvdb::GridBase::Ptr(doubles)));
    handles.push_back(nanovdb::openToNanoVDB(openvdb::GridBase::Ptr(integers)));
    nanovdb::io::writeGrids((dir / "a.nvdb").string(), handles);
    const VdbGrids read = readAll(dir / "a.nvdb");
    ASSERT_EQ(read.grids.size(), 2u);
    ASSERT_TRUE(read.grids[0]->isType<openvdb::DoubleGrid>());
    const auto& first = static_cast<const openvdb::DoubleGrid&>(*read.grids[0]).tree();
    EXPECT_EQ(first.background(), 0.1);
    EXPECT_EQ(first.getValue({1, -2, 3}), 1.0 / 3);
    ASSERT_TRUE(read.grids[1]->isType<openvdb::Int32Grid>());
    const auto& second = static_cast<const openvdb::Int32Grid&>(*read.grids[1]).tree();
    EXPECT_EQ(second.background(), -7);
    EXPECT_EQ(second.getValue({1, -2, 3}), 16777217);
}

/// Masks, points and what else holds no numbers are listed as what they are, beside a density.
TEST(NanoVdbPeer, GridsWithoutNumbersAreNamedAndLeaveTheOthers) {
    const TempDir dir;
    std::vector<Handle> handles;
    const auto mask = openvdb::MaskGrid::create();
    mask->setName("density");
    mask->tree().setValueOn({1, 2, 3});
    handles.push_back(nanovdb::openToNanoVDB(openvdb::GridBase::Ptr(mask)));
    handles.push_back(quantised<float>(*sample()));
    nanovdb::io::writeGrids((dir / "a.nvdb").string(), handles);
    const VdbFile listed = listGrids(dir / "a.nvdb");
    EXPECT_EQ(describeGrids(listed), "density[0] (mask), density[1] (float)");
    EXPECT_FALSE(listed.grids[0].usable());
    EXPECT_NE(listed.grids[0].unusable.find("grid of mask"), std::string::npos);
    EXPECT_TRUE(listed.grids[1].usable());
    // Of two of one name, the one that holds numbers is meant.
    EXPECT_EQ(findGrid(listed, "density").grid.uniqueName, "density[1]");
    EXPECT_EQ(findGrid(listed, GridRole::Density).grid.uniqueName, "density[1]");
}

TEST(NanoVdbPeer, CompressedFilesAndWeakerChecksumsAreTheSameGrid) {
    const TempDir dir;
    using nanovdb::ChecksumMode;
    using nanovdb::io::Codec;
    for (const ChecksumMode checksum :
         {ChecksumMode::Disable, ChecksumMode::Partial, ChecksumMode::Full})
        for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
            write(dir / "a.nvdb", quantised<float>(*sample(), checksum), codec);
            const openvdb::FloatGrid::Ptr read = readOne(dir / "a.nvdb");
            const openvdb::FloatGrid::Ptr source = sample();
            EXPECT_TRUE(read->tree().hasSameTopology(source->tree()));
            for (auto it = source->cbeginValueAll(); it; ++it)
                ASSERT_EQ(read->tree().getValue(it.getCoord()), *it);
        }
}

/// Bits flipped and ends cut off, where the most is decided: in the heads and the masks of nodes.
/// Without checksums, which would find nearly all of it.
TEST(NanoVdbPeer, DamagedFilesDoNoHarm) {
    const TempDir dir;
    using nanovdb::io::Codec;
    const auto grid = sample();
    const auto plain = nanovdb::ChecksumMode::Disable;
    write(dir / "0", quantised<float>(*grid, plain));
    write(dir / "1", quantised<nanovdb::FpN>(*grid, plain));
    write(dir / "2", quantised<nanovdb::Fp4>(*grid, plain));
    write(dir / "3", quantised<float>(*grid, plain), Codec::ZIP);
    write(dir / "4", quantised<float>(*grid, plain), Codec::BLOSC);
    write(dir / "5", quantised<nanovdb::Fp8>(*grid));
    RandomStream random(9);
    int errors = 0, grids = 0;
    for (int sampleIndex = 0; sampleIndex < 6; ++sampleIndex) {
        const std::string healthy = readText(dir / std::to_string(sampleIndex));
        for (int variant = 0; variant < 150; ++variant) {
            std::string bytes = healthy;
            if (variant % 5 == 0) bytes.resize(random.bits() % bytes.size());
            const std::size_t reach = variant % 2 ? 1300 : variant % 4 ? 20000 : bytes.size();
            if (variant % 5 != 0)
                for (int i = 0; i < 1 + variant % 7; ++i)
                    bytes[random.bits() % std::min(reach, bytes.size())] ^=
                        static_cast<char>(1 << random.bits() % 8);
            writeText(dir / "a.nvdb", bytes);
            try {
                readAll(dir / "a.nvdb");
                ++grids;
            } catch (const Error& e) {
                EXPECT_NE(std::string(e.what()).find("a.nvdb"), std::string::npos) << e.what();
                ++errors;
            }
        }
    }
    EXPECT_GT(errors, 300);
    EXPECT_GT(grids, 100);
}

/// All entries of an upper node refer to one node below: 32768 times what the file holds.
TEST(NanoVdbPeer, NodesThatAreSharedAreAnError) {
    const TempDir dir;
    Handle handle = quantised<float>(*sample(), nanovdb::ChecksumMode::Disable);
    auto* const upper = handle.grid<float>()->tree().getFirstUpper();
    auto* const lower = handle.grid<float>()->tree().getFirstLower();
    for (std::uint32_t n = 0; n < 32768; ++n) {
        const_cast<nanovdb::Mask<5>&>(upper->childMask()).setOn(n);
        upper->data()->setChild(n, lower);
    }
    write(dir / "a.nvdb", std::move(handle));
    expectError(ErrorKind::Input, "more nodes of level 0 than the 48",
                [&] { readAll(dir / "a.nvdb"); });
}

}  // namespace
}  // namespace woodcock::test

#endif
