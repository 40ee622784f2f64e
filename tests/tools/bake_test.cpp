// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/bake/ax_expression.h"
#include "woodcock/bake/recipe.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/grid/vdb/openvdb_trees.h"
#include "woodcock/image/read_image.h"

namespace woodcock::test {

using namespace bake;
using namespace grid;
using namespace image;
namespace {

namespace fs = std::filesystem;

constexpr const char* ball = R"(about = "a ball"
[parameters]
size = { default = 1, range = [0.1, 10], about = "its radius" }
[bounds]
min = [-2, -2, -2]
max = [2, 2, 2]
[[output]]
name = "density"
node = { type = "falloff", edge = 0.5, input = { type = "sphere", radius = "size" } }
)";

class BakeCommand : public testing::Test {
protected:
    void SetUp() override { writeText(dir / "ball.toml", ball); }
    std::string file(const std::string& name) const { return (dir / name).string(); }

    ProgramResult bake(std::vector<std::string> more) const {
        more.insert(more.begin(), "bake");
        return runProgram(more);
    }
    void expectFailure(const std::vector<std::string>& arguments, int exitCode,
                       const std::string& said) const {
        const ProgramResult result = bake(arguments);
        EXPECT_EQ(result.exitCode, exitCode) << fmt::format("{}", fmt::join(arguments, " "));
        EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
        std::size_t files = 0;
        for ([[maybe_unused]] const auto& entry : fs::directory_iterator(dir.path())) ++files;
        EXPECT_EQ(files, 1u) << "something is left behind";
    }

    TempDir dir;
};

TEST_F(BakeCommand, MakesAVolume) {
    const ProgramResult result = bake({file("ball.toml"), "-o", file("ball.vdb"), "--resolution",
                                       "81", "--set", "size=1.5", "--half"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const LoadedGrid grid = loadGrid(file("ball.vdb"), "density");
    EXPECT_EQ(grid.field.voxel({0, 0, 0}), 1);
    EXPECT_EQ(grid.field.voxel({30, 0, 0}), 0);  // 1.5 of 0.05
    EXPECT_GT(grid.field.voxel({29, 0, 0}), 0);
    const GridListing listing = listGrids(file("ball.vdb")).grids.at(0);
    EXPECT_EQ(listing.gridClass, GridClass::FogVolume);
    EXPECT_EQ(listing.valueType, "half-saved float");
    EXPECT_NEAR(listing.voxelSize.x, 0.05, 1e-12);
    openvdb::initialize();
    openvdb::io::File in(file("ball.vdb"));
    in.open();
    const openvdb::MetaMap::Ptr metadata = in.getMetadata();
    EXPECT_EQ(metadata->metaValue<std::string>("parameters"), "seed=1 time=0 size=1.5");
    EXPECT_NE(metadata->metaValue<std::string>("recipe").find("ball.toml"), std::string::npos);
    EXPECT_EQ(metadata->metaValue<std::string>("creator").find("woodcock "), 0u);
}

TEST_F(BakeCommand, TheSameBytesWithAnyThreads) {
    const auto make = [&](const std::string& name, const std::string& threads) {
        const ProgramResult result = bake({"cumulus", "-q", "-o", file(name), "--resolution", "60",
                                           "--threads", threads, "--seed", "7"});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return readText(file(name));
    };
    const std::string one = make("1.vdb", "1");
    EXPECT_EQ(one, make("2.vdb", "2"));
    EXPECT_EQ(one, make("3.vdb", "3"));
}

TEST_F(BakeCommand, ListsPresetsAndParameters) {
    const ProgramResult list = bake({"--list"});
    EXPECT_EQ(list.exitCode, 0);
    for (const auto& preset : presets())
        EXPECT_NE(list.out.find(preset.first), std::string::npos) << preset.first;
    const ProgramResult one = bake({file("ball.toml"), "--describe"});
    EXPECT_NE(one.out.find("its radius [0.1 to 10]"), std::string::npos) << one.out;
}

TEST_F(BakeCommand, SavesARecipeThatBakesTheSame) {
    ASSERT_EQ(bake({"cumulus", "--write-recipe", file("mine.toml")}).exitCode, 0);
    EXPECT_EQ(readText(file("mine.toml")), presets().at("cumulus"));
}

TEST_F(BakeCommand, SamplesAVolumeLikeAnother) {
    ASSERT_EQ(bake({file("ball.toml"), "-o", file("a.vdb"), "--voxel", "0.05"}).exitCode, 0);
    ASSERT_EQ(bake({file("ball.toml"), "-o", file("b.vdb"), "--voxel", "0.1"}).exitCode, 0);
    const ProgramResult result =
        bake({file("a.vdb"), "-o", file("c.vdb"), "--like", file("b.vdb")});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const LoadedGrid b = loadGrid(file("b.vdb"), "density"), c = loadGrid(file("c.vdb"), "density");
    EXPECT_EQ(b.worldFromIndex, c.worldFromIndex);
    for (int x = -11; x <= 11; ++x)
        for (int y = -11; y <= 11; ++y)  // every second voxel of a.vdb sits on one of b.vdb
            EXPECT_NEAR(b.field.voxel({x, y, 2}), c.field.voxel({x, y, 2}), 1e-6);
}

TEST_F(BakeCommand, RendersAPreview) {
    const ProgramResult result = bake({file("ball.toml"), "-o", file("ball.vdb"), "--resolution",
                                       "40", "--preview", file("ball.png"), "--lod", "1"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(fs::exists(file("ball.png")));
    EXPECT_TRUE(fs::exists(file("ball.lod1.vdb")));
}

/// The first of this name on $PATH; empty for none.
fs::path findOnPath(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream directories(path ? path : "");
    for (std::string directory; std::getline(directories, directory, ':');)
        if (fs::exists(fs::path(directory) / name)) return fs::path(directory) / name;
    return {};
}

// Blender's box is one of whole leaves, from the first voxel's position to the last one's.
TEST_F(BakeCommand, BlenderSeesTheSame) {
    const fs::path blender = findOnPath("blender");
    if (blender.empty()) GTEST_SKIP() << "there is no blender on the path";
    ASSERT_EQ(bake({file("ball.toml"), "-o", file("ball.vdb"), "--voxel", "0.05"}).exitCode, 0);
    const ProgramResult result =
        runProgram({"-b", "--python-exit-code", "9", "--python",
                    (sourceDir() / "tests/programs/blender_volume.py").string(), "--",
                    file("ball.vdb"), "density"},
                   {}, blender);
    const std::size_t line = result.out.find("VOLUME ");
    if (line == std::string::npos && result.out.find("pyopenvdb") != std::string::npos)
        GTEST_SKIP() << "this Blender has no pyopenvdb";
    ASSERT_NE(line, std::string::npos) << result.out << result.err;
    const auto seen =
        nlohmann::json::parse(result.out.substr(line + 7, result.out.find('\n', line) - line - 7));
    EXPECT_EQ(seen["type"], "FLOAT");
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            EXPECT_FLOAT_EQ(seen["matrix"][i][j].get<float>(), i != j ? 0.f : i < 3 ? 0.05f : 1.f);

    openvdb::initialize();
    openvdb::io::File in(file("ball.vdb"));
    in.open();
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(in.readGrid("density"));
    EXPECT_EQ(seen["active"], grid->activeVoxelCount());
    openvdb::CoordBBox leaves;
    grid->tree().evalLeafBoundingBox(leaves);
    for (const auto& corner : seen["box"])
        for (std::size_t c = 0; c < 3; ++c) {
            const auto axis = static_cast<int>(c);
            const double at = corner[c].get<double>();
            EXPECT_LT(std::min(std::abs(at - 0.05 * leaves.min()[axis]),
                               std::abs(at - 0.05 * leaves.max()[axis])),
                      1e-5);
        }
    EXPECT_GT(seen["values"].size(), 1000u);
    for (const auto& v : seen["values"])
        EXPECT_EQ(v[3].get<float>(), grid->tree().getValue(openvdb::Coord(v[0], v[1], v[2])));
}

TEST_F(BakeCommand, MakesAFrameAtEachTime) {
    const std::string rolling =
        std::string(ball) + "[node.unused]\ntype = \"sphere\"\nradius = 1\n";
    std::string text = rolling;
    text.replace(text.find("radius = \"size\""), 15, "radius = \"size + time / 4\"");
    writeText(dir / "ball.toml", text);
    const ProgramResult result = bake({file("ball.toml"), "-o", file("b.###.vdb"), "--time",
                                       "0:1:0.25", "--resolution", "41", "--json", "-q"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const auto frames = nlohmann::json::parse(result.out).at("frames");
    ASSERT_EQ(frames.size(), 5U);
    for (int n = 1; n <= 5; ++n) {
        const std::string name = fmt::format("b.{:03}.vdb", n);
        const auto& frame = frames[static_cast<std::size_t>(n - 1)];
        EXPECT_EQ(frame.at("frame"), n);
        EXPECT_EQ(frame.at("parameters").at("time"), (n - 1) * 0.25);
        EXPECT_EQ(frame.at("files")[0].at("file"), file(name));
        EXPECT_EQ(frame.at("files")[0].at("bytes"), fs::file_size(file(name)));
        ASSERT_EQ(bake({file("ball.toml"), "-o", file("one.vdb"), "--resolution", "41", "--time",
                        fmt::format("{}", (n - 1) * 0.25)})
                      .exitCode,
                  0);
        EXPECT_EQ(readText(file(name)), readText(file("one.vdb"))) << name;
    }
    EXPECT_FALSE(fs::exists(file("b.006.vdb")));

    // Frame 7 is at (7 - 1) / 24 seconds.
    ASSERT_EQ(bake({file("ball.toml"), "-o", file("f.##.vdb"), "--frames", "6-7", "--resolution",
                    "41", "--preview", file("p.#.png")})
                  .exitCode,
              0);
    ASSERT_EQ(
        bake({file("ball.toml"), "-o", file("one.vdb"), "--resolution", "41", "--time", "0.25"})
            .exitCode,
        0);
    EXPECT_EQ(readText(file("f.07.vdb")), readText(file("one.vdb")));
    EXPECT_NE(readText(file("f.06.vdb")), readText(file("one.vdb")));
    EXPECT_TRUE(fs::exists(file("p.6.png")));
    EXPECT_TRUE(fs::exists(file("p.7.png")));
}

TEST_F(BakeCommand, WrongFramesAreNamed) {
    const std::string in = file("ball.toml"), out = file("x.vdb"), many = file("x.####.vdb");
    const auto wrong = [&](std::vector<std::string> more, const std::string& said) {
        more.insert(more.begin(), in);
        expectFailure(more, 2, said);
    };
    wrong({"-o", out, "--time", "0:1:0.5"}, "such as '" + file("x.####.vdb") + "'");
    wrong({"-o", out, "--frames", "1-2"}, "there are 2 frames and one file");
    wrong({"-o", many}, "#### stands for a frame's number, and no frames are asked for");
    wrong({"-o", many, "--time", "3"}, "#### stands for a frame's number");
    for (const char* pattern : {"{frame}", "*", "%4d"}) {
        const std::string name = file(std::string("x.") + pattern + ".vdb");
        wrong({"-o", name}, std::string(pattern) + " is not filled in");
        wrong({"-o", name, "--frames", "1-2"}, "put ####, %04d, $F4 or <frame04> where");
    }
    wrong({"-o", many, "--time", "0:1:0"}, "--time 0:1:0: the step is 0; it must be above 0");
    wrong({"-o", many, "--time", "0:1:-0.5"}, "the step is -0.5");
    wrong({"-o", many, "--time", "1:0:0.5"}, "it ends before it begins");
    wrong({"-o", many, "--time", "0:1"}, "FROM:TO:STEP");
    wrong({"-o", many, "--time", "0:1:x"}, "--time 0:1:x: 'x'");
    wrong({"-o", many, "--time", "0:1:1e-6"}, "these are 1000001 frames; at most 100000");
    wrong({"-o", many, "--frames", "9-8x-1"}, "the step is -1");
    wrong({"-o", many, "--frames", "1-"}, "is no frame and no range");
    wrong({"-o", many, "--frames", "0-99999999"}, "at most 100000");
    wrong({"-o", many, "--frames", "1-2", "--time", "0:1:1"}, "contradict");
    wrong({"-o", out, "--fps", "25"}, "--fps is for --frames");
    wrong({"-o", many, "--frames", "1-2", "--preview", file("p.png")}, "--preview");
}

TEST_F(BakeCommand, AnInterruptKeepsTheFramesBefore) {
    RunningProgram running({"bake", "cumulus", "-o", file("x.#.vdb"), "--frames", "1-100000",
                            "--resolution", "40", "--progress", "json"});
    EXPECT_NE(running.awaitLine("wrote"), "");
    running.signal(SIGTERM);
    const ProgramResult result = running.wait();
    EXPECT_EQ(result.exitCode, 130);
    EXPECT_NE(result.err.find("done: 1"), std::string::npos) << result.err;
    EXPECT_FALSE(loadGrid(file("x.1.vdb"), "density").field.support().empty());
}

TEST_F(BakeCommand, AnInterruptEndsExpressions) {
    if (!axAvailable()) GTEST_SKIP() << "this build has no OpenVDB AX";
    writeText(dir / "loop.toml", R"([bounds]
min = [-1, -1, -1]
max = [1, 1, 1]
[node.a]
type = "ax"
input = { type = "falloff", edge = 0.3, input = { type = "sphere", radius = 0.8 } }
code = "for (int i = 0; i < 900000; ++i) @density = sin(@density + i);"
[[output]]
name = "density"
node = "a"
)");
    RunningProgram running({"bake", file("loop.toml"), "-o", file("x.vdb"), "--resolution", "64",
                            "--progress", "json"});
    EXPECT_NE(running.awaitLine("\"fraction\""), "");
    running.signal(SIGINT);
    EXPECT_EQ(running.wait().exitCode, 130);
    EXPECT_FALSE(fs::exists(file("x.vdb")));
}

/// Of a preview's middle, where the volume is; display values, 0 to 1.
Rgb middle(const fs::path& picture) {
    const Image image = readImage(picture);
    Rgb sum(0.0f);
    for (int y = -20; y < 20; ++y)
        for (int x = -20; x < 20; ++x) sum += image.at(image.width / 2 + x, image.height / 2 + y);
    return sum * (1 / 1600.0f);
}

TEST_F(BakeCommand, PreviewsShowWhatTheGridsAreFor) {
    const std::string grids = R"(
[[output]]
name = "OTHER"
mask = "density"
node = THING
)";
    const auto preview = [&](std::string more) {
        writeText(dir / "look.toml", ball + more);
        const ProgramResult result = bake({file("look.toml"), "-o", file("look.vdb"),
                                           "--resolution", "33", "--preview", file("look.png")});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return middle(file("look.png"));
    };
    const auto with = [&](const std::string& name, const std::string& node) {
        std::string text = grids;
        text.replace(text.find("OTHER"), 5, name);
        text.replace(text.find("THING"), 5, node);
        return preview(text);
    };
    const Rgb white = preview("");
    EXPECT_LT(white[0], 1.25f * white[2]) << "a sun that is a little warm";
    const Rgb green = with("Cd", R"({ type = "vector", x = 0.1, y = 0.9, z = 0.1 })");
    EXPECT_GT(green[1], 1.5f * green[0]);
    const Rgb flame = with("flame", "0.5");
    EXPECT_GT(flame[0], 1.25f * flame[2]);
    const Rgb hot = with("temperature", "2000");
    EXPECT_GT(hot[0], 1.25f * hot[2]);
    const Rgb cold = with("temperature", "300");
    EXPECT_LT(cold[0], 1.25f * cold[2]);
    const Rgb own = preview(R"(
[preview]
scene = """
[[volume]]
file = "${VOLUME}"
scale = $(50 / size)
albedo = [0.05, 0.1, 0.9]
[[light]]
type = "environment"
"""
)");
    EXPECT_GT(own[2], 1.5f * own[0]);
}

TEST_F(BakeCommand, APreviewsMistakesAreNamedBeforeTheBake) {
    const auto refused = [&](const std::string& scene, const std::string& said) {
        writeText(dir / "ball.toml",
                  std::string(ball) + "[preview]\nscene = '''\n" + scene + "\n'''\n");
        expectFailure({file("ball.toml"), "-o", file("x.vdb"), "--preview", file("x.png")}, 3,
                      said);
    };
    refused("[[light]]\ntype = \"environment\"", "shows no volume");
    refused("[[volume]]\nfile = \"${VOLUME}\"\nalbdo = 1", "albdo");
    refused("[[volume]]\nfile = \"${VOLUME}\"\nscale = $(2 * nothing)", "nothing");
    refused("[[volume]]\nfile = \"${VOLUME}\"\nscale = $(2", "$( without a closing )");
}

TEST_F(BakeCommand, WrongUseIsNamed) {
    const std::string in = file("ball.toml"), out = file("x.vdb");
    expectFailure({}, 2, "name a preset (");
    expectFailure({in}, 2, "there is no output");
    expectFailure({"cumullus", "-o", out}, 2, "did you mean 'cumulus'");
    expectFailure({file("no.toml"), "-o", out}, 3, "does not exist");
    expectFailure({in, "-o", file("x.exr")}, 2, "woodcock convert");
    expectFailure({in, "-o", file("no/x.vdb")}, 2, "there is no directory");
    expectFailure({in, "-o", out, "--set", "sise=2"}, 2, "did you mean 'size'");
    expectFailure({in, "-o", out, "--set", "size"}, 2, "NAME=VALUE");
    expectFailure({in, "-o", out, "--set", "size=20"}, 2, "between 0.1 and 10");
    expectFailure({in, "-o", out, "--voxel", "0"}, 2, "--voxel");
    expectFailure({in, "-o", out, "--voxel", "0.0001"}, 3, "--max-voxels");
    expectFailure({in, "-o", out, "--voxel", "2e-6", "--set", "size=0.1", "--max-voxels", "1e15"},
                  3, "too small for a VDB file");
    expectFailure({in, "-o", out, "--max-voxels", "10"}, 3, "--max-voxels");
    expectFailure({in, "-o", out, "--like", file("no.vdb")}, 3, "no.vdb");
    expectFailure({in, "-o", out, "--half", "--float"}, 2, "--half");
    expectFailure({in, "-o", out, "--preview", file("x.bmp")}, 2, "x.bmp");
}

TEST_F(BakeCommand, AnInterruptLeavesNothing) {
    RunningProgram running(
        {"bake", "cumulus", "-o", file("x.vdb"), "--resolution", "1500", "--progress", "json"});
    EXPECT_NE(running.awaitLine("\"fraction\""), "");
    running.signal(SIGINT);
    EXPECT_EQ(running.wait().exitCode, 130);
    EXPECT_FALSE(fs::exists(file("x.vdb")));
    for (const auto& entry : fs::directory_iterator(dir.path()))
        EXPECT_EQ(entry.path().filename(), "ball.toml");
}

}  // namespace
}  // namespace woodcock::test
