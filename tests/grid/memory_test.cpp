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

}  // namespace
}  // namespace woodcock::test
