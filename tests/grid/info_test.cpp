// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;

namespace {

using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(Info, SpeaksOfAllGridsAndWhatIsWrongWithThem) {
    const TempDir dir;
    GridSpec minus{.name = "shadow", .box = {{0, 0, 0}, {4, 4, 4}}};
    minus.value = [](Vec3i) { return -1.0; };
    writeVdb(
        dir / "a.vdb",
        {{.name = "density",
          .voxels = {{{0, 0, 0}, {1}}, {{9, 1, 2}, {3}}, {{2, 0, 0}, {70000}}},
          .worldFromIndex = Affine3d::translate({1, 2, 3})},
         minus,
         {.name = "dust", .type = VdbType::Points},
         {.name = "sdf", .voxels = {{{0, 0, 0}, {1}}}, .gridClass = "level set"},
         {.name = "sick",
          .voxels = {{{1, 2, 3}, {std::numeric_limits<double>::quiet_NaN()}}, {{0, 0, 0}, {1}}}}});
    const ProgramResult r = runProgram({"info", dir / "a.vdb"});
    EXPECT_EQ(r.exitCode, 0) << r.err;
    for (const char* part :
         {"density  float, fog volume", "bounds     [0, 0, 0] to [9, 1, 2], 10 x 2 x 3 voxels",
          "in world   [1, 2, 3] to [10, 3, 5]", "active     3 voxels (5 % of the bounds)",
          "values     1 to 70000, mean 23334.7, background 0", "exceed the range of half storage",
          "all of its active voxels are -1", "dust  points", "it holds points and no values",
          "it is a level set", "it holds 1 NaN voxel (first at [1, 2, 3])"})
        EXPECT_TRUE(holds(r.out, part)) << part << "\n" << r.out;
}

TEST(Info, OneGridByName) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {{.name = "density", .voxels = {{{0, 0, 0}, {1}}}},
                             {.name = "flame", .voxels = {{{0, 0, 0}, {1}}}}});
    const Json j =
        Json::parse(runProgram({"info", "--json", "--grid", "flame", dir / "a.vdb"}).out);
    ASSERT_EQ(j["files"][0]["grids"].size(), 1u);
    EXPECT_EQ(j["files"][0]["grids"][0]["name"], "flame");
    const ProgramResult wrong = runProgram({"info", "--grid", "flam", dir / "a.vdb"});
    EXPECT_EQ(wrong.exitCode, 3);
    EXPECT_TRUE(holds(wrong.err, "did you mean 'flame'?")) << wrong.err;
}

TEST(Info, BadFilesDoNotHideGoodOnes) {
    const TempDir dir;
    writeVdb(dir / "good.vdb", {{.voxels = {{{0, 0, 0}, {1}}}}});
    writeText(dir / "bad.vdb", "no VDB at all");
    const std::vector<std::string> files{dir / "missing.vdb", dir / "bad.vdb", dir / "good.vdb"};
    ProgramResult r = runProgram({"info", files[0], files[1], files[2]});
    EXPECT_EQ(r.exitCode, 3);
    EXPECT_TRUE(holds(r.err, "missing.vdb does not exist")) << r.err;
    EXPECT_TRUE(holds(r.err, "bad.vdb is not a VDB file")) << r.err;
    EXPECT_TRUE(holds(r.out, "density  float, fog volume")) << r.out;
    r = runProgram({"info", "--json", files[0], files[1], files[2]});
    EXPECT_EQ(r.exitCode, 3);
    const Json j = Json::parse(r.out);
    ASSERT_EQ(j["files"].size(), 3u);
    EXPECT_TRUE(j["files"][0].contains("error"));
    EXPECT_EQ(j["files"][2]["grids"][0]["active_voxels"], 1);
}

TEST(Info, NeedsAFile) { EXPECT_EQ(runProgram({"info"}).exitCode, 2); }

TEST(InfoAssets, TeapotCloudAsJson) {  // numbers of `vdb_print -l`
    const auto file = sharedDir() / "assets/teapot_cloud.vdb";
    if (!exists(file)) GTEST_SKIP() << "no " << file;
    const ProgramResult r = runProgram({"info", "--json", file});
    ASSERT_EQ(r.exitCode, 0) << r.err;
    const Json grid = Json::parse(r.out)["files"][0]["grids"][0];
    EXPECT_EQ(grid["type"], "float");
    EXPECT_EQ(grid["class"], "fog volume");
    EXPECT_EQ(grid["active_voxels"], 1963736);
    EXPECT_EQ(grid["active_tiles"], 2326);
    EXPECT_EQ(grid["index_bounds"], Json::parse("[[-136,-60,-90],[130,73,87]]"));
    EXPECT_NEAR(grid["voxel_size"][0].get<double>(), 0.00767, 5e-6);
    EXPECT_EQ(grid["max"], 50);
    EXPECT_EQ(grid["openvdb_bytes"], 8779904);
    EXPECT_GE(grid["majorants"]["majorant_over_mean"].get<double>(), 1);
    EXPECT_TRUE(grid["remarks"].empty());
}

}  // namespace
}  // namespace woodcock::test
