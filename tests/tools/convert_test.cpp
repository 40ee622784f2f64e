// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <tuple>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/grid/nanovdb/file.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/mesh/triangle_mesh.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace mesh;
using namespace proof;

namespace {

namespace fs = std::filesystem;

/// 12 x 10 x 9 numbers with zeros on all sides and within.
std::string numbers() {
    std::string bytes;
    for (int z = 0; z < 9; ++z)
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 12; ++x) {
                const bool inside = x > 1 && x < 10 && y > 0 && y < 8 && z > 2 && (x + y) % 3;
                const float v = inside ? static_cast<float>(x + 12 * (y + 10 * z)) / 7 : 0;
                bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
            }
    return bytes;
}

class Convert : public testing::Test {
protected:
    void SetUp() override { writeText(dir / "a.raw", numbers()); }

    std::string file(const std::string& name) const { return (dir / name).string(); }

    ProgramResult convert(const std::string& in, const std::string& out,
                          std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"convert", file(in), file(out)});
        const ProgramResult result = runProgram(more);
        EXPECT_EQ(result.out, "");
        return result;
    }
    void expectDone(const std::string& in, const std::string& out,
                    const std::vector<std::string>& more = {}) const {
        const ProgramResult result = convert(in, out, more);
        EXPECT_EQ(result.exitCode, 0) << result.err;
    }
    void expectRefused(int exitCode, const std::string& said, const std::string& in,
                       const std::string& out, const std::vector<std::string>& more = {}) const {
        const ProgramResult result = convert(in, out, more);
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        EXPECT_NE(result.err.find(said), std::string::npos)
            << "says:     " << result.err << "expected: " << said;
        const std::size_t error = result.err.find("error:");
        EXPECT_NE(error, std::string::npos) << result.err;
        EXPECT_EQ(result.err.find('\n', error), result.err.size() - 1) << result.err;
        EXPECT_TRUE(in == out || !fs::exists(file(out))) << out;
        for (const auto& entry : fs::directory_iterator(dir.path()))
            EXPECT_FALSE(entry.path().filename().string().ends_with(".part")) << entry.path();
    }

    const TempDir dir;
    const std::vector<std::string> layout{"--dims", "12,10,9", "--type", "f32"};
    const std::vector<std::string> all{"--bounds", "0,0,0,11,9,8"};
};

TEST_F(Convert, EachFormatGoesThroughVdbUnchanged) {
    expectDone("a.raw", "a.vdb", layout);
    expectDone("a.vdb", "b.raw", all);
    EXPECT_EQ(readText(file("b.raw")), readText(file("a.raw")));
    for (const std::string format : {"npy", "vol", "nrrd"}) {
        // Straight from the numbers, and once around through a VDB.
        expectDone("a.raw", "direct." + format, layout);
        expectDone("direct." + format, format + ".vdb");
        expectDone(format + ".vdb", "around." + format, all);
        EXPECT_EQ(readText(file("around." + format)), readText(file("direct." + format))) << format;
        expectDone("around." + format, format + ".raw");
        EXPECT_EQ(readText(file(format + ".raw")), readText(file("a.raw"))) << format;
    }
}

TEST_F(Convert, IntegersAndDoublesToo) {
    for (const std::string type : {"u8", "i16", "u16", "u32", "f64"}) {
        expectDone("a.raw", "n.raw",
                   {"--dims", "12,10,9", "--type", "f32", "--scale", "0.5", "--out-type", type});
        expectDone("n.raw", "n.vdb", {"--dims", "12,10,9", "--type", type});
        expectDone("n.vdb", "m.raw", {"--bounds", "0,0,0,11,9,8", "--out-type", type});
        EXPECT_EQ(readText(file("m.raw")), readText(file("n.raw"))) << type;
    }
}

TEST_F(Convert, SaysWhatItReadAssumedAndWrote) {
    const ProgramResult result = convert("a.raw", "a.vdb", layout);
    for (const char* said :
         {"12 x 10 x 9 voxels of f32", "values 0 to", "assumed", "wrote", "active voxels", "bytes"})
        EXPECT_NE(result.err.find(said), std::string::npos) << said << "\n" << result.err;
    std::vector<std::string> half = layout;
    half.insert(half.end(), {"--precision", "half"});
    EXPECT_NE(convert("a.raw", "a.vdb", half).err.find("values change by"), std::string::npos);
}

TEST_F(Convert, RefusesWrongUsage) {
    expectRefused(2, "--dims X,Y,Z", "a.raw", "a.vdb");
    expectRefused(2, "the input and the output", "a.raw", "a.raw", layout);
    EXPECT_EQ(readText(file("a.raw")), numbers());
    expectRefused(2, "can be written", "a.raw", "a.png", layout);
    expectRefused(2, "unknown format 'np'; did you mean 'npy'?", "a.raw", "a.vdb",
                  {"--from", "np"});
    expectRefused(2, "--dims: '12,10'", "a.raw", "a.vdb", {"--dims", "12,10", "--type", "u8"});
    expectRefused(2, "--type: 'f3'", "a.raw", "a.vdb", {"--dims", "1,1,1", "--type", "f3"});
    expectRefused(2, "--axes: 'xxy'", "a.raw", "a.vdb", {"--axes", "xxy"});
    expectRefused(2, "--clamp", "a.raw", "a.vdb", {"--clamp", "1,0"});
    expectRefused(2, "give one", "a.raw", "a.vdb", {"--voxel", "1", "--size", "1"});
    expectRefused(2, "there is no directory", "a.raw", "none/a.vdb", layout);
    expectRefused(2, "--grid", "a.raw", "a.vdb",
                  {"--dims", "12,10,9", "--type", "f32", "--grid", "x"});
}

TEST_F(Convert, NamesNoFileAfterAPattern) {
    for (const char* pattern : {"####", "%04d", "$F4"})
        expectRefused(2, std::string(pattern) + " stands for a frame's number", "a.raw",
                      std::string("b.") + pattern + ".vdb", layout);
}

TEST_F(Convert, RefusesBadInput) {
    expectRefused(3, "4320", "a.raw", "a.vdb", {"--dims", "12,10,9", "--type", "f64"});
    expectRefused(3, "12 x 10 x 9 would fit", "a.raw", "a.vdb",
                  {"--dims", "12,10,7", "--type", "f32"});
    writeText(file("a.npy"), "no array");
    expectRefused(3, "NumPy", "a.npy", "a.vdb");
    writeText(file("a.qqq"), "x");
    expectRefused(3, "known: vdb", "a.qqq", "a.vdb");
    expectRefused(3, "does not exist", "none.npy", "a.vdb");
    expectRefused(3, "there are no files", "s.####.png", "a.vdb");
    std::string bytes = numbers();
    bytes.replace(0, 4, std::string("\x00\x00\xc0\x7f", 4));
    writeText(file("nan.raw"), bytes);
    expectRefused(3, "1 NaN voxel (first at [0, 0, 0])", "nan.raw", "a.vdb", layout);
    std::vector<std::string> repair = layout;
    repair.push_back("--repair");
    expectDone("nan.raw", "a.vdb", repair);
}

TEST_F(Convert, AFullDiskLeavesNothing) {
    for (const std::string out : {"a.vdb", "a.npy", "a.vol", "a.nrrd"}) {
        std::vector<std::string> arguments{"convert", file("a.raw"), file(out)};
        arguments.insert(arguments.end(), layout.begin(), layout.end());
        const ProgramResult result = runProgram(arguments, {.fileSize = 600});
        EXPECT_EQ(result.exitCode, 1) << result.err;
        EXPECT_NE(result.err.find("File too large"), std::string::npos) << result.err;
        EXPECT_FALSE(fs::exists(file(out)));
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), {}), 1);
}

TEST_F(Convert, ChoosesGridsAndTurnsThem) {
    GridSpec density, heat;
    density.voxels = {{{1, 2, 3}, {5}}, {{2, 2, 3}, {6}}};
    heat.name = "heat";
    heat.voxels = {{{0, 0, 0}, {9}}};
    writeVdb(dir / "two.vdb", {density, heat});
    expectRefused(3, "density, heat", "two.vdb", "a.npy");
    expectRefused(3, "did you mean 'heat'", "two.vdb", "a.npy", {"--grid", "heet"});
    expectDone("two.vdb", "heat.raw", {"--grid", "heat", "--out-type", "u8"});
    EXPECT_EQ(readText(file("heat.raw")), "\x09");
    expectDone("two.vdb", "turned.raw",
               {"--grid", "density", "--axes", "-x,y,z", "--out-type", "u8"});
    EXPECT_EQ(readText(file("turned.raw")), "\x06\x05");
}

/// Sides that differ, along the axes of the file, before it is turned.
TEST_F(Convert, TakesThreeSidesOfVoxels) {
    const auto sides = [&](std::vector<std::string> more) {
        more.insert(more.begin(), layout.begin(), layout.end());
        expectDone("a.raw", "a.vdb", more);
        return listGrids(file("a.vdb")).grids.at(0).voxelSize;
    };
    EXPECT_EQ(sides({"--voxel", "0.5"}), (Vec3d{0.5, 0.5, 0.5}));
    EXPECT_EQ(sides({"--voxel", "0.5,0.25,2"}), (Vec3d{0.5, 0.25, 2}));
    EXPECT_EQ(sides({"--voxel", "0.5,0.25,2", "--axes", "xzy"}), (Vec3d{0.5, 2, 0.25}));
    EXPECT_EQ(sides({"--size", "6,10,18"}), (Vec3d{0.5, 1, 2}));
    expectRefused(2, "--voxel: '1,2'", "a.raw", "b.vdb", {"--voxel", "1,2"});
    expectRefused(2, "--voxel: '1,0,1'", "a.raw", "b.vdb", {"--voxel", "1,0,1"});
    // Places on the command line stand above a box that is none.
    std::string empty = "VOL\x03";
    for (const int n : {1, 12, 10, 9, 1, 0, 0, 0, 0, 0, 0})
        empty.append(reinterpret_cast<const char*>(&n), sizeof n);
    writeText(file("a.vol"), empty + numbers());
    const ProgramResult cube = convert("a.vol", "c.vdb");
    EXPECT_NE(cube.err.find("unit cube"), std::string::npos) << cube.err;
    const Vec3d voxel = listGrids(file("c.vdb")).grids.at(0).voxelSize;
    EXPECT_DOUBLE_EQ(voxel.x, 1.0 / 12);
    EXPECT_DOUBLE_EQ(voxel.y, 1.0 / 10);
    EXPECT_DOUBLE_EQ(voxel.z, 1.0 / 9);
    expectDone("a.vol", "c.vdb", {"--voxel", "0.5"});
    EXPECT_EQ(listGrids(file("c.vdb")).grids.at(0).voxelSize, (Vec3d{0.5, 0.5, 0.5}));
}

/// Each output keeps what it can of them, and the others say that they do not.
TEST_F(Convert, HonoursPrecisionAndCompressionOrRefusesThem) {
    std::vector<std::string> more = layout;
    const auto with = [&](std::initializer_list<const char*> options) {
        more = layout;
        more.insert(more.end(), options.begin(), options.end());
        return more;
    };
    const auto size = [&](const std::string& name) { return fs::file_size(file(name)); };
    expectDone("a.raw", "a.nrrd", layout);
    expectDone("a.raw", "zip.nrrd", with({"--compression", "zip"}));
    EXPECT_LT(size("zip.nrrd"), size("a.nrrd"));
    expectDone("zip.nrrd", "zip.raw");
    EXPECT_EQ(readText(file("zip.raw")), numbers());
    expectDone("a.raw", "half.npy", with({"--precision", "half"}));
    EXPECT_EQ(size("half.npy"), 128 + 2u * 12 * 10 * 9);
    expectDone("a.raw", "double.npy", with({"--precision", "double"}));
    EXPECT_EQ(size("double.npy"), 128 + 8u * 12 * 10 * 9);
    for (const char* format : {"raw", "npy", "vol"})
        expectRefused(2, "--compression is for vdb, nvdb and nrrd", "a.raw",
                      std::string("b.") + format, with({"--compression", "zip"}));
    expectRefused(2, "none or zip", "a.raw", "b.nrrd", with({"--compression", "blosc"}));
    expectRefused(2, "holds no halves", "a.raw", "b.nrrd", with({"--precision", "half"}));
    expectRefused(2, "holds no halves", "a.raw", "b.vol", with({"--precision", "half"}));
    expectRefused(2, "holds only f32", "a.raw", "b.vol", with({"--precision", "double"}));
    expectRefused(2, "give one", "a.raw", "b.raw",
                  with({"--precision", "half", "--out-type", "u8"}));
    if (!hasNanoVdb()) GTEST_SKIP() << "this build has no NanoVDB";
    expectDone("a.raw", "a.nvdb", layout);
    for (const char* codec : {"zip", "blosc"}) {
        expectDone("a.raw", "packed.nvdb", with({"--compression", codec}));
        EXPECT_LT(size("packed.nvdb"), size("a.nvdb") / 10);
        expectDone("packed.nvdb", "packed.raw", all);
        EXPECT_EQ(readText(file("packed.raw")), numbers());
    }
    more = with({"--precision", "half"});
    EXPECT_NE(convert("a.raw", "half.nvdb", more).err.find("Fp16"), std::string::npos);
    EXPECT_EQ(listGrids(file("half.nvdb")).grids.at(0).valueType, "Fp16");
    expectDone("a.raw", "double.nvdb", with({"--precision", "double"}));
    EXPECT_EQ(listGrids(file("double.nvdb")).grids.at(0).valueType, "double");
    GridSpec vectors{.name = "vel", .type = VdbType::Vec3d, .voxels = {{{0, 0, 0}, {0.1, 1, 2}}}};
    writeVdb(dir / "v.vdb", {vectors});
    for (const char* precision : {"float", "double"}) {
        const ProgramResult result = convert("v.vdb", "v.nvdb", {"--precision", precision});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        // 0.1 as a float: off by 1.49e-09.
        EXPECT_NE(result.err.find("change by 1.49e-09"), std::string::npos) << result.err;
        EXPECT_EQ(listGrids(file("v.nvdb")).grids.at(0).valueType, "vec3s");
    }
    EXPECT_NE(convert("v.vdb", "v.nvdb").err.find("change by 1.49e-09"), std::string::npos);
}

/// Every type of numbers goes everywhere; what holds none is left out and named.
TEST_F(Convert, TakesGridsOfEveryType) {
    const auto grid = [](const char* name, VdbType type) {
        GridSpec spec{.name = name, .type = type};
        for (const int x : {1, 2, 8, 9}) spec.voxels.push_back({{x, 2, 3}, {1, 1, 1}});
        spec.tiles = {{{8, 0, 0}, 8, {1, 1, 1}, true}};
        return spec;
    };
    const std::vector<std::pair<const char*, VdbType>> types{
        {"float", VdbType::Float}, {"double", VdbType::Double}, {"int32", VdbType::Int32},
        {"int64", VdbType::Int64}, {"bool", VdbType::Bool},     {"mask", VdbType::Mask},
        {"vec3s", VdbType::Vec3s}, {"vec3d", VdbType::Vec3d},   {"vec3i", VdbType::Vec3i}};
    std::vector<GridSpec> specs;
    for (const auto& [name, type] : types) specs.push_back(grid(name, type));
    GridSpec points{.name = "dust", .type = VdbType::Points};
    specs.push_back(points);
    writeVdb(dir / "all.vdb", specs);
    std::vector<std::string> outputs{"all2.vdb"};
    if (hasNanoVdb()) outputs.push_back("all.nvdb");
    for (const std::string& out : outputs) {
        const ProgramResult result = convert("all.vdb", out);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_NE(result.err.find("'dust' of"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("is left out"), std::string::npos) << result.err;
        const VdbFile written = listGrids(file(out));
        ASSERT_EQ(written.grids.size(), types.size()) << out;
        for (std::size_t i = 0; i < types.size(); ++i)
            EXPECT_EQ(written.grids[i].name, types[i].first);
    }
    for (const auto& [name, type] : types)
        for (const std::string& source : outputs) {
            expectDone(source, "a.raw",
                       {"--grid", name, "--out-type", "u8", "--bounds", "1,2,3,9,2,3"});
            const bool vector = std::string_view(name).starts_with("vec3");
            const std::string on = vector ? "\x01\x01\x01" : "\x01";
            const std::string off(on.size(), '\0');
            EXPECT_EQ(readText(file("a.raw")), on + on + off + off + off + off + off + on + on)
                << name << " of " << source;
        }
    expectRefused(3, "float, double, int32, int64, bool, mask, vec3s, vec3d, vec3i", "all.vdb",
                  "a.npy");
    writeVdb(dir / "two.vdb", {grid("density", VdbType::Float), grid("density", VdbType::Float),
                               grid("", VdbType::Float), grid("", VdbType::Float)});
    expectRefused(3, "--grid: density[0], density[1], [0], [1]", "two.vdb", "a.npy");
    expectDone("two.vdb", "one.raw", {"--grid", "[1]"});
}

TEST_F(Convert, TakesAListOfSlices) {
    for (const int n : {9, 10, 11})
        writeFloats(dir / ("s." + std::to_string(n) + ".exr"), 1, 1, 1, {static_cast<float>(n)});
    const auto run = [&](std::vector<std::string> files) {
        for (std::string& name : files) name = file(name);
        files.insert(files.begin(), "convert");
        return runProgram(files);
    };
    const ProgramResult done = run({"s.10.exr", "s.11.exr", "s.9.exr", "s.raw"});
    EXPECT_EQ(done.exitCode, 0) << done.err;
    const float expected[]{9, 10, 11};
    EXPECT_EQ(readText(file("s.raw")),
              std::string(reinterpret_cast<const char*>(expected), sizeof expected));
    const ProgramResult gap = run({"s.11.exr", "s.9.exr", "t.raw"});
    EXPECT_EQ(gap.exitCode, 3);
    EXPECT_NE(gap.err.find("are missing between 9 and 11: 10"), std::string::npos) << gap.err;
    const ProgramResult other = run({"a.raw", "s.9.exr", "t.raw"});
    EXPECT_EQ(other.exitCode, 2);
    EXPECT_NE(other.err.find("convert other files one by one"), std::string::npos) << other.err;
    const ProgramResult one = run({"s.9.exr", "t.raw"});
    EXPECT_EQ(one.exitCode, 3);
    EXPECT_NE(one.err.find("slice.####.exr"), std::string::npos) << one.err;
    const ProgramResult alone = run({"s.9.exr"});
    EXPECT_EQ(alone.exitCode, 2);
    EXPECT_NE(alone.err.find("name an input and an output"), std::string::npos) << alone.err;
}

TEST_F(Convert, HintsAtHounsfieldUnits) {
    std::string bytes;
    for (int i = 0; i < 8; ++i) {
        const short v[]{-1024, -1000, -90, 0, 40, 300, 1200, 3071};
        bytes.append(reinterpret_cast<const char*>(&v[i]), 2);
    }
    writeText(file("ct.raw"), bytes);
    const std::vector<std::string> dims{"--dims", "2,2,2", "--type", "i16"};
    const ProgramResult hinted = convert("ct.raw", "ct.vdb", dims);
    EXPECT_NE(hinted.err.find("Hounsfield"), std::string::npos) << hinted.err;
    // What it says to do leaves no hint, and air empty and water 1.
    std::vector<std::string> more = dims;
    for (const char* word : {"--scale", "0.001", "--offset", "1", "--clamp", "0,5"})
        more.emplace_back(word);
    const ProgramResult followed = convert("ct.raw", "ct.vdb", more);
    EXPECT_EQ(followed.err.find("Hounsfield"), std::string::npos) << followed.err;
    expectDone("ct.vdb", "out.raw", {"--bounds", "0,0,0,1,1,1"});
    const std::string out = readText(file("out.raw"));
    std::vector<float> values(8);
    ASSERT_EQ(out.size(), 32u);
    std::memcpy(values.data(), out.data(), 32);
    EXPECT_EQ(values[0], 0);
    EXPECT_EQ(values[1], 0);
    EXPECT_EQ(values[3], 1);
    EXPECT_FLOAT_EQ(values[7], 4.071f);
}

/// A NanoVDB file is a volume wherever a VDB is.
TEST_F(Convert, NanoVdbIsDrawnAndInspected) {
    if (!hasNanoVdb()) GTEST_SKIP() << "this build has no NanoVDB";
    expectDone("a.raw", "a.vdb", layout);
    expectDone("a.vdb", "a.nvdb", {"--compression", "blosc"});
    const auto render = [&](const std::string& in, const std::string& out) {
        const ProgramResult result = runProgram({"render", file(in), "-o", file(out), "--res",
                                                 "8x8", "--spp", "4", "--seed", "1", "-q"});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return readBack(file(out)).values;
    };
    EXPECT_EQ(render("a.nvdb", "n.exr"), render("a.vdb", "v.exr"));
    const ProgramResult info = runProgram({"info", file("a.nvdb")});
    EXPECT_EQ(info.exitCode, 0) << info.err;
    EXPECT_NE(info.out.find("NanoVDB 32.4"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("density"), std::string::npos) << info.out;
    const ProgramResult none = runProgram({"info", file("a.nvdb"), "--grid", "heat"});
    EXPECT_EQ(none.exitCode, 3);
    EXPECT_NE(none.err.find("it has: density (float)"), std::string::npos) << none.err;
}

/// The distance to a ball about voxel (8, 8, 8), known up to 3 voxels.
GridSpec ball(const std::string& name, double radius) {
    GridSpec spec;
    spec.name = name;
    spec.gridClass = "level set";
    spec.background = {3};
    spec.box = {{0, 0, 0}, {16, 16, 16}};
    spec.value = [radius](Vec3i v) {
        return std::clamp(length((v - Vec3i{8, 8, 8}).as<double>()) - radius, -3.0, 3.0);
    };
    return spec;
}

std::vector<std::string> namesIn(const std::string& file) {
    std::vector<std::string> names;
    for (const GridListing& grid : listGrids(file).grids) names.push_back(grid.uniqueName);
    return names;
}

TEST_F(Convert, FogOfALevelSetTakesNoOthersName) {
    GridSpec density, heat;
    density.voxels = {{{1, 2, 3}, {5}}};
    heat = density;
    heat.name = "temperature";
    using Names = std::vector<std::string>;
    const std::tuple<std::vector<GridSpec>, std::vector<std::string>, Names> conversions[]{
        {{ball("surface", 5)}, {}, {"density"}},
        {{ball("surface", 5)}, {"--name", "ball"}, {"ball"}},
        {{ball("surface", 5), heat}, {}, {"density", "temperature"}},
        {{ball("surface", 5), density}, {}, {"surface", "density"}},
        {{density, ball("surface", 5)}, {}, {"density", "surface"}},
        {{ball("density", 5), density}, {}, {"density_fog", "density"}},
        {{ball("a", 5), ball("b", 4)}, {}, {"a", "b"}},
        {{ball("a", 5), ball("a", 4)}, {}, {"a_fog", "a"}},
        {{ball("", 5), density}, {}, {"fog", "density"}},
        {{ball("surface", 5), density}, {"--grid", "surface"}, {"density"}},
        {{ball("surface", 5), density}, {"--grid", "density"}, {"density"}}};
    for (const auto& [grids, options, names] : conversions) {
        writeVdb(dir / "in.vdb", grids);
        expectDone("in.vdb", "out.vdb", options);
        EXPECT_EQ(namesIn(file("out.vdb")), names);
    }
    expectDone("in.vdb", "density.raw", {"--grid", "density", "--out-type", "u8"});
    EXPECT_EQ(readText(file("density.raw")), "\x05");
    expectRefused(2, "--name is for one grid", "in.vdb", "none.vdb", {"--name", "x"});
}

const std::string box =
    "v -1 -1 -1\nv -1 -1 1\nv -1 1 -1\nv -1 1 1\nv 1 -1 -1\nv 1 -1 1\nv 1 1 -1\nv 1 1 1\n"
    "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\n";

TEST_F(Convert, OpenMeshesAreRefusedAndToldOfTheShell) {
    if (!canReadMeshes()) GTEST_SKIP() << "this build has no Assimp";
    writeText(file("open.obj"), box);
    expectRefused(3, "open.obj: the mesh is open: 4 edges", "open.obj", "a.vdb",
                  {"--voxel", "0.1"});
    expectRefused(3, "--shell", "open.obj", "a.vdb");
    expectDone("open.obj", "shell.vdb", {"--voxel", "0.1", "--shell"});
    writeText(file("closed.obj"), box + "f 2 6 8 4\n");
    expectDone("closed.obj", "closed.vdb", {"--voxel", "0.1"});
}

TEST_F(Convert, WhatIsNotReadIsNamedWithAWayOn) {
    std::string dicom(200, '\0');
    dicom.replace(128, 4, "DICM");
    writeText(file("slice.raw"), dicom);
    writeText(file("slice.txt"), dicom);
    expectRefused(3,
                  "slice.raw is a DICOM file, which woodcock does not read; load the whole series",
                  "slice.raw", "a.vdb", {"--dims", "10,10,2", "--type", "u8"});
    expectRefused(3, "is a DICOM file", "slice.txt", "a.vdb");
    expectDone("slice.raw", "forced.vdb", {"--from", "raw", "--dims", "10,10,2", "--type", "u8"});
    writeText(file("scan.las"), "LASF");
    expectRefused(3, "a LAS or LAZ point cloud, which woodcock does not read; run `pdal",
                  "scan.las", "a.vdb");
    expectRefused(3, "load the whole series", "slice.####.dcm", "a.vdb");
    expectRefused(3, "is a folder", ".", "a.vdb");
}

TEST_F(Convert, ColumnsOfPointsAreSaidAndChosen) {
    writeText(file("a.xyz"), "0 0 0 3\n1 1 1 4\n");
    const ProgramResult result = convert("a.xyz", "a.vdb", {"--voxel", "0.1"});
    EXPECT_EQ(result.exitCode, 0);
    for (const char* said : {"column 4 is not used", "--columns x,y,z,radius"})
        EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
    expectDone("a.xyz", "b.vdb", {"--voxel", "0.5", "--columns", "x,y,z,radius"});
    expectRefused(2, "--columns is for these formats: ply and points", "a.raw", "c.vdb",
                  {"--dims", "12,10,9", "--type", "f32", "--columns", "x,y,z"});
}

TEST_F(Convert, MitsubaReadsItsVolumes) {
    const char* given = std::getenv("WOODCOCK_MITSUBA_PYTHON");
    const std::string python = given ? given : "python3";
    const auto run = [&](const std::string& script) {
        writeText(file("script.py"), script);
        return std::system(
            fmt::format("'{}' '{}' > '{}' 2>&1", python, file("script.py"), file("log")).c_str());
    };
    if (run("import mitsuba, numpy") != 0)
        GTEST_SKIP() << "no Mitsuba in " << python << " (WOODCOCK_MITSUBA_PYTHON names another)";
    std::vector<std::string> placed = layout;
    placed.insert(placed.end(), {"--voxel", "0.5", "--origin", "1.25,2.25,3.25"});
    expectDone("a.raw", "a.vol", placed);
    // Every voxel, and the value at the place in the world where the VDB has it.
    std::string text = R"(import mitsuba as mi, numpy as np
mi.set_variant('scalar_rgb')
raw, vol = 'RAW', 'VOL'
a = np.fromfile(raw, '<f4').reshape(9, 10, 12)
assert np.array_equal(np.array(mi.VolumeGrid(vol)).reshape(9, 10, 12), a)
v = mi.load_dict({'type': 'gridvolume', 'filename': vol, 'use_grid_bbox': True})
it = mi.Interaction3f()
for x, y, z in ((2, 2, 3), (9, 7, 8), (5, 3, 4)):
    it.p = mi.Point3f(1.25 + 0.5 * x, 2.25 + 0.5 * y, 3.25 + 0.5 * z)
    assert abs(v.eval_1(it) - a[z, y, x]) <= 1e-4 * a.max(), (x, y, z)
)";
    text.replace(text.find("'RAW'"), 5, "'" + file("a.raw") + "'");
    text.replace(text.find("'VOL'"), 5, "'" + file("a.vol") + "'");
    EXPECT_EQ(run(text), 0) << readText(file("log"));
}

}  // namespace
}  // namespace woodcock::test
