// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/write_vdb.h"

namespace woodcock::test {
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
