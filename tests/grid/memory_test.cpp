// SPDX-License-Identifier: Apache-2.0
// A field is no larger than the tree that it was read from.
#include <gtest/gtest.h>

#include "tests/oracle/vdb_values.h"
#include "tests/support/paths.h"
#include "tests/support/write_vdb.h"
#include "woodcock/grid/vdb_load.h"

namespace woodcock::test {
namespace {

void expectFrugal(const std::filesystem::path& file) {
    const auto tree = static_cast<double>(VdbValues(file, "density").treeBytes);
    const auto field = [&](Storage storage) {
        return static_cast<double>(loadGrid(file, "density", {.storage = storage}).field.bytes());
    };
    EXPECT_LE(field(Storage::Float) / tree, 1);
    EXPECT_LE(field(Storage::Half) / tree, 0.75);
}

TEST(FieldMemory, OfACloudFromProduction) {
    const auto teapot = sharedDir() / "assets" / "teapot_cloud.vdb";
    if (!std::filesystem::exists(teapot)) GTEST_SKIP() << "no " << teapot;
    expectFrugal(teapot);
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
    expectFrugal(dir / "ball.vdb");
}

/// Leaves far from each other, as in a shell or in spray.
TEST(FieldMemory, OfAThinShell) {
    GridSpec shell;
    for (int i = 0; i < 4000; ++i) {
        const double z = 1 - (2 * i + 1) / 4000.0, phi = 2.399963 * i, r = std::sqrt(1 - z * z);
        const Vec3i centre = floorToInt(Vec3d{r * std::cos(phi), r * std::sin(phi), z} * 900);
        for (int k = 0; k < 5; ++k)
            shell.voxels.push_back({centre + Vec3i{k, 0, k % 2}, {0.25 + 0.1 * k}});
    }
    const TempDir dir;
    writeVdb(dir / "shell.vdb", {shell}, VdbCompression::None);
    const auto tree = loadGrid(dir / "shell.vdb", "density").statistics.openVdbBytes;
    EXPECT_LE(loadGrid(dir / "shell.vdb", "density", {.storage = Storage::Float}).field.bytes(), tree);
    EXPECT_LE(static_cast<double>(
                  loadGrid(dir / "shell.vdb", "density", {.storage = Storage::Half}).field.bytes()),
              0.75 * static_cast<double>(tree));
}

}  // namespace
}  // namespace woodcock::test
