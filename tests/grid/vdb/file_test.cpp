// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/file.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/grid/nanovdb/file.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

const std::vector<VdbVoxel> one{{{0, 0, 0}, {1, 1, 1}}};

class VdbFileTest : public ::testing::Test {
protected:
    VdbFile list(const std::vector<GridSpec>& grids) {
        writeVdb(file_, grids);
        return listGrids(file_);
    }
    void expectBad(const std::string& message) {
        expectError(ErrorKind::Input, message, [&] { listGrids(file_); });
    }
    std::string name() const { return file_.string(); }

    TempDir dir_;
    std::filesystem::path file_ = dir_ / "smoke.vdb";
};

TEST_F(VdbFileTest, ListsTypesClassesAndMetadataInOrder) {
    const VdbFile file = list({{.name = "density", .voxels = one, .saveAsHalf = true},
                               {.name = "v", .type = VdbType::Vec3s, .gridClass = "staggered"},
                               {.name = "id",
                                .type = VdbType::Int64,
                                .gridClass = "unknown",
                                .metadata = {{"author", "somebody"}}},
                               {.name = "dust", .type = VdbType::Points},
                               {.name = "sdf", .gridClass = "level set"}});
    EXPECT_EQ(describeGrids(file),
              "density (half-saved float), v (vec3s), id (int64), dust "
              "(points), sdf (float)");
    EXPECT_EQ(file.grids[0].gridClass, GridClass::FogVolume);
    EXPECT_EQ(file.grids[1].gridClass, GridClass::Staggered);
    EXPECT_EQ(file.grids[1].channels, 3);
    EXPECT_EQ(file.grids[2].gridClass, GridClass::Unknown);
    const auto& metadata = file.grids[2].metadata;
    EXPECT_NE(std::find(metadata.begin(), metadata.end(),
                        std::pair<std::string, std::string>("author", "somebody")),
              metadata.end());
    EXPECT_TRUE(file.grids[2].usable());
    EXPECT_EQ(file.grids[3].channels, 0);
    EXPECT_FALSE(file.grids[3].usable());
    EXPECT_FALSE(file.grids[4].usable());
}

TEST_F(VdbFileTest, DuplicatesHaveNumbers) {
    const VdbFile file = list({{.voxels = {{{0, 0, 0}, {1}}}},
                               {.voxels = {{{0, 0, 0}, {2}}}},
                               {.voxels = {{{0, 0, 0}, {3}}}}});
    EXPECT_EQ(describeGrids(file), "density[0] (float), density[1] (float), density[2] (float)");
    EXPECT_EQ(loadGrid(file_, "density[2]").field.voxel({0, 0, 0}), 3);
    const LoadedGrid first = loadGrid(file_, "density");
    EXPECT_EQ(first.field.voxel({0, 0, 0}), 1);
    EXPECT_EQ(first.notes.at(0), name() + " holds 3 grids named 'density'; took density[0]");
    expectError(ErrorKind::Input, "grid 'density[3]' not found",
                [&] { loadGrid(file_, "density[3]"); });
}

TEST_F(VdbFileTest, AnUnknownTypeDoesNotHideTheOtherGrids) {
    writeVdb(file_, {{.name = "density", .voxels = one},
                     {.name = "names", .type = VdbType::Int64, .voxels = one}});
    patchFile(file_, "Tree_int64_5_4_3", "Tree_quark_5_4_3");
    const VdbFile file = listGrids(file_);
    EXPECT_EQ(describeGrids(file), "density (float), names (quark)");
    EXPECT_FALSE(file.grids[1].usable());
    EXPECT_EQ(loadGrid(file_, "density").field.voxel({0, 0, 0}), 1);
    expectError(ErrorKind::Input,
                "grid 'names' in " + name() + " cannot be used: grids of quark are not supported",
                [&] { loadGrid(file_, "names"); });
}

TEST_F(VdbFileTest, SingularTransform) {
    const double voxel = 0.7310585786300049;
    const auto bytes = [](double v) { return std::string(reinterpret_cast<const char*>(&v), 8); };
    writeVdb(file_, {{.voxels = one, .worldFromIndex = Affine3d::scale({voxel, voxel, voxel})}});
    patchFile(file_, bytes(voxel), bytes(0));
    expectError(ErrorKind::Input, "its transform is singular", [&] { loadGrid(file_, "density"); });
    writeVdb(file_, {{.voxels = one, .worldFromIndex = Affine3d::scale({voxel, voxel, voxel})}});
    patchFile(file_, bytes(voxel), bytes(1e-315));
    expectError(ErrorKind::Input, "its transform has an axis 1e-315 long",
                [&] { loadGrid(file_, "density"); });
}

TEST_F(VdbFileTest, TinyVoxelsKeepTheirTransform) {
    const double voxel = 0.7310585786300049;
    const auto bytes = [](double v) { return std::string(reinterpret_cast<const char*>(&v), 8); };
    writeVdb(file_, {{.voxels = one, .worldFromIndex = Affine3d::scale({voxel, voxel, voxel})}});
    patchFile(file_, bytes(voxel), bytes(1e-7));  // smaller than OpenVDB itself would write
    EXPECT_EQ(loadGrid(file_, "density").worldFromIndex, Affine3d::scale({1e-7, 1e-7, 1e-7}));
}

TEST_F(VdbFileTest, FilesThatAreNone) {
    expectBad(name() + " does not exist");
    std::filesystem::create_directory(file_);
    expectBad(name() + " is a directory; expected a .vdb file");
    std::filesystem::remove(file_);
    writeText(file_, "");
    expectBad(name() + " is not a VDB file: it is empty");
    writeText(file_, "hello\tworld, this is text");
    expectBad(name() + " is not a VDB file: it begins with \"hello\\x09world, thi\"");
    writeText(file_, "NanoVDB0 and more bytes");
    if (hasNanoVdb()) expectBad(name() + " is of NanoVDB's format");
    writeText(file_, "version https://git-lfs.github.com/spec/v1\noid sha256:0");
    expectBad("is not a VDB file but a Git LFS pointer");
}

TEST_F(VdbFileTest, EveryTruncationIsFound) {
    GridSpec spec{.box = {{0, 0, 0}, {20, 20, 20}}};
    spec.value = [](Vec3i v) { return 1.0 + v.x; };
    writeVdb(file_, {spec, {.name = "flame", .voxels = one}});
    const std::string whole = readText(file_);
    for (std::size_t n = 0; n < whole.size(); n += n < 600 ? 7 : 1009) {
        writeText(file_, whole.substr(0, n));
        expectError(ErrorKind::Input, name(), [&] { listGrids(file_); });
    }
    writeText(file_, whole.substr(0, whole.size() - 1));
    expectBad("is cut short: grid 'flame' ends at byte");
}

TEST_F(VdbFileTest, FormatsBeforeOpenVdb3AreNamed) {
    writeVdb(file_, {{.voxels = one}});
    std::string bytes = readText(file_);
    bytes[8] = '\xdd';  // 221, the low byte of the format's number
    writeText(file_, bytes);
    expectBad(name() + " has VDB file format 221, older than the 222 of OpenVDB 3");
}

TEST_F(VdbFileTest, TheFormatOfOpenVdb13IsKnown) {
    writeVdb(file_, {{.voxels = {{{1, 2, 3}, {4}}}}});
    setVdbFormat(file_, 225);
    const VdbFile file = listGrids(file_);
    EXPECT_NE(file.version.find("file format 225"), std::string::npos) << file.version;
    EXPECT_EQ(file.warning, "");
    EXPECT_EQ(loadGrid(file_, "density").field.voxel({1, 2, 3}), 4);
}

TEST_F(VdbFileTest, NewerFormatsAreTried) {
    for (const std::uint32_t number : {226u, 300u, 0xffffffffu}) {
        GridSpec spec{.box = {{0, 0, 0}, {9, 9, 9}}};
        spec.value = [](Vec3i v) { return 1.0 + v.x; };
        writeVdb(file_, {spec}, VdbCompression::None);
        setVdbFormat(file_, number);
        const std::string doubt = "its VDB file format, " + std::to_string(number) +
                                  ", is newer than 225, the newest that is known (of OpenVDB 13)";
        EXPECT_EQ(listGrids(file_).warning,
                  name() + ": " + doubt + "; it is read as the newest known format");
        EXPECT_EQ(loadGrid(file_, "density").field.voxel({3, 0, 0}), 4);

        // Two more bytes than are expected, or fewer: the walk through the file ends elsewhere.
        const std::string sound = readText(file_);
        const std::string way =
            "; " + doubt + ": save it with a program that uses OpenVDB 13 or an older one";
        writeText(file_, sound.substr(0, sound.size() - 2));
        expectBad(way);
        writeText(file_, sound.substr(0, 70) + "??" + sound.substr(70));
        expectBad(way);
    }
}

TEST_F(VdbFileTest, NamesAreFoundInAnyCase) {
    const VdbFile file = list({{.name = "Density", .voxels = one}, {.name = "Cd", .voxels = one}});
    EXPECT_EQ(findGrid(file, "Cd").note, "");
    EXPECT_EQ(findGrid(file, "density").grid.name, "Density");
    EXPECT_EQ(findGrid(file, "density").note, "'density' is 'Density' in " + name());
}

TEST_F(VdbFileTest, AWrongNameListsWhatThereIs) {
    const VdbFile file = list(
        {{.name = "density"}, {.name = "flame"}, {.name = "velocity", .type = VdbType::Vec3s}});
    expectError(ErrorKind::Input,
                "grid 'desnity' not found in " + name() +
                    "; did you mean 'density'? it has: "
                    "density (float), flame (float), velocity (vec3s)",
                [&] { findGrid(file, "desnity"); });
    expectError(ErrorKind::Input,
                "grid 'flame[1]' not found in " + name() +
                    "; [0], [1], ... number the grids of one name, in the file's order; it has: "
                    "density (float), flame (float), velocity (vec3s)",
                [&] { findGrid(file, "flame[1]"); });
    expectError(ErrorKind::Input, "grid 'xyz' not found in " + name() + "; it has: density (float)",
                [&] { findGrid(file, "xyz"); });
}

TEST_F(VdbFileTest, RolesByTheirUsualNames) {
    const VdbFile file = list({{.name = "shadow"},
                               {.name = "smoke"},
                               {.name = "TEMPERATURE"},
                               {.name = "Flames"},
                               {.name = "CD", .type = VdbType::Vec3s},
                               {.name = "vel", .type = VdbType::Vec3s}});
    EXPECT_EQ(findGrid(file, GridRole::Density).grid.name, "smoke");
    EXPECT_EQ(findGrid(file, GridRole::Temperature).grid.name, "TEMPERATURE");
    EXPECT_EQ(findGrid(file, GridRole::Emission).grid.name, "Flames");
    EXPECT_EQ(findGrid(file, GridRole::Colour).grid.name, "CD");
    EXPECT_EQ(findGrid(file, GridRole::Velocity).grid.name, "vel");
    EXPECT_TRUE(hasRole(file, GridRole::Velocity));
}

TEST_F(VdbFileTest, TheOnlyScalarGridIsTheDensityUnlessItsNameSaysOtherwise) {
    const FoundGrid only = findGrid(
        list({{.name = "cloud"}, {.name = "shadow"}, {.name = "v", .type = VdbType::Vec3s}}),
        GridRole::Density);
    EXPECT_EQ(only.grid.name, "cloud");
    EXPECT_NE(only.note.find("took 'cloud'"), std::string::npos);
    const std::string message = "no density grid in " + name() + " (looked for: density, smoke)";
    for (const std::vector<GridSpec>& grids : {std::vector<GridSpec>{{.name = "shadow"}},
                                               {{.name = "temperature"}},
                                               {{.name = "a"}, {.name = "b"}},
                                               {{.name = "sdf", .gridClass = "level set"}},
                                               {}}) {
        const VdbFile file = list(grids);
        expectError(ErrorKind::Input, message, [&] { findGrid(file, GridRole::Density); });
    }
}

TEST(VdbAssets, TheListingOfAFireCacheReadsNoVoxels) {
    const auto path = sharedDir() / "assets/fire_0045.vdb";
    if (!exists(path)) GTEST_SKIP() << "no " << path;
    const VdbFile file = listGrids(path);
    EXPECT_EQ(describeGrids(file),
              "velocity (half-saved vec3s), density (half-saved float), shadow (half-saved float), "
              "temperature (half-saved float), flame (half-saved float)");
    EXPECT_EQ(findGrid(file, GridRole::Density).grid.name, "density");
    EXPECT_EQ(file.grids[0].gridClass, GridClass::Staggered);
}

/// vdb_lod's levels of detail are one thing at several resolutions: the finest is drawn.
TEST_F(VdbFileTest, TheFinestLevelOfDetailIsTheGrid) {
    const auto level = [](const char* name) { return GridSpec{.name = name, .voxels = one}; };
    writeVdb(file_,
             {level("density_level_2"), level("density_level_0.5"), level("density_level_10"),
              level("temperature_level_0"), level("density_level_x")});
    const VdbFile file = listGrids(file_);
    for (const FoundGrid& found : {findGrid(file, GridRole::Density), findGrid(file, "Density")}) {
        EXPECT_EQ(found.grid.name, "density_level_0.5");
        EXPECT_NE(found.note.find("took 'density_level_0.5', the finest"), std::string::npos)
            << found.note;
    }
    EXPECT_TRUE(hasRole(file, GridRole::Temperature));
    EXPECT_EQ(findGrid(file, "density_level_2").note, "");
    EXPECT_FALSE(hasRole(file, GridRole::Emission));
}

}  // namespace
}  // namespace woodcock::test
