// SPDX-License-Identifier: Apache-2.0
// A field is no larger than the tree that it was read from.
#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/proof/oracles/vdb_values.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace oracle;
using namespace proof;

namespace {

void expectFrugal(const std::filesystem::path& file, const std::string& what) {
    const auto tree = static_cast<double>(vdbTreeBytes(file, "density"));
    const auto field = [&](Storage storage) {
        return static_cast<double>(loadGrid(file, "density", {.storage = storage}).field.bytes());
    };
    EXPECT_LE(field(Storage::Float) / tree, 1) << what;
    EXPECT_LE(field(Storage::Half) / tree, 0.75) << what;
}

TEST(FieldMemory, OfACloudFromProduction) {
    const auto teapot = sharedDir() / "assets" / "teapot_cloud.vdb";
    if (!std::filesystem::exists(teapot)) GTEST_SKIP() << "no " << teapot;
    expectFrugal(teapot, "teapot");
}

TEST(FieldMemory, OfALargeBall) {
    GridSpec ball;
    ball.box = {{-120, -120, -120}, {120, 120, 120}};
    ball.value = [](Vec3i v) {
        const double r = length(v.as<double>()) / 120;
        return r < 1 ? 0.5 + 0.5 * std::sin(20 * r) * std::cos(0.3 * v.x) : 0;
    };
    const TempDir dir;
    writeVdb(dir / "ball.vdb", {ball}, VdbCompression::None);
    expectFrugal(dir / "ball.vdb", "ball");
}

/// A grid of single voxels, each made from a direction.
GridSpec spots(int count, double radius) {
    GridSpec grid;
    for (int i = 0; i < count; ++i) {  // evenly over the sphere, by the golden angle
        const double z = 1 - 2 * (i + 0.5) / count, turn = 2.399963 * i;
        const double r = std::sqrt(1 - z * z);
        const Vec3d at = Vec3d{r * std::cos(turn), r * std::sin(turn), z} * radius;
        grid.voxels.push_back({floorToInt(at), {0.1 + 0.01 * (i % 7)}});
    }
    return grid;
}

TEST(FieldMemory, OfScatteredVoxels) {
    const TempDir dir;
    for (const auto& [count, radius] : {std::pair{4000, 900.0}, {200, 20000.0}, {1, 1.0}}) {
        writeVdb(dir / "spots.vdb", {spots(count, radius)});
        expectFrugal(dir / "spots.vdb", std::to_string(count) + " voxels");
    }
}

TEST(FieldMemory, OfAThinShell) {
    const TempDir dir;
    writeVdb(dir / "shell.vdb", {spots(200000, 250)});
    expectFrugal(dir / "shell.vdb", "shell");
}

TEST(FieldMemory, OfTilesAlone) {
    GridSpec tiles;
    for (int i = 0; i < 1000; ++i)
        tiles.tiles.push_back({{i % 10 * 128, i / 10 % 10 * 128, i / 100 * 128}, 128, {0.5}});
    for (int i = 0; i < 1000; ++i)
        tiles.tiles.push_back({{i % 10 * -8 - 8, i / 10 % 10 * -8 - 8, i / -100 * 8}, 8, {0.5}});
    const TempDir dir;
    writeVdb(dir / "tiles.vdb", {tiles});
    expectFrugal(dir / "tiles.vdb", "tiles");
}

}  // namespace
}  // namespace woodcock::test
