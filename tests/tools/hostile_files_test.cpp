// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/write_image.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;

namespace {

namespace fs = std::filesystem;

/// Outputs where something lies already, inputs that never end, and names that do harm.
class HostileFiles : public testing::Test {
protected:
    void SetUp() override {
        GridSpec grid;
        grid.name = "density";
        grid.box = {{0, 0, 0}, {7, 7, 7}};
        grid.value = [](Vec3i p) { return 0.5 + 0.03 * p.x; };
        writeVdb(dir / "in.vdb", {grid});
        writeText(dir / "s.toml", scene);
    }

    std::string file(const std::string& name) const { return (dir / name).string(); }

    /// A line of the shell, in which W is the program, from within the directory.
    ProgramResult shell(const std::string& line) const {
        return runProgram({"-c", fmt::format("cd '{}' && W='{}' && {}", dir.path().string(),
                                             program().string(), line)},
                          {}, "/bin/sh");
    }

    const std::string scene =
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nscale = 1\n"
        "[camera]\neye = [0, 0, 4]\nlook_at = [0, 0, 0]\n"
        "[render]\nresolution = [8, 8]\nspp = 1\n";
    const std::string recipe =
        "[bounds]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n"
        "[[output]]\nname = \"density\"\nnode = \"n\"\n";
    const TempDir dir;
};

TEST_F(HostileFiles, AFullStdoutIsAFailure) {
    writeImage(dir / "a.exr", {});
    for (const std::string command :
         {"info in.vdb", "info --json in.vdb", "bake --list", "bake ink --describe",
          "bake ink --write-recipe -", "compare a.exr a.exr", "compare a.exr a.exr --json",
          "render s.toml --write-scene -", "render s.toml -o b.exr --stats -", "--help",
          "render --help", "--version"})
        for (const char* where : {"> /dev/full", ">&-"}) {
            const ProgramResult result = shell("\"$W\" " + command + " " + where);
            EXPECT_EQ(result.exitCode, 1) << command << where << result.err;
            EXPECT_NE(result.err.find("cannot write to stdout: "), std::string::npos)
                << command << where << result.err;
        }
    EXPECT_TRUE(fs::exists(dir / "b.exr"));  // what could be written was
}

TEST_F(HostileFiles, AReaderThatEndsEndsNoRender) {
    const ProgramResult result = shell(
        "\"$W\" render s.toml -o a.exr --res 64x64 --spp 16 --progress bar 2>&1 | head -c 10");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(fs::exists(dir / "a.exr"));
}

TEST_F(HostileFiles, AClosedTerminalLosesNoPicture) {
    RunningProgram running(
        {"render", file("s.toml"), "-o", file("a.exr"), "--spp", "16777216", "--progress", "json"});
    ASSERT_TRUE(running.awaitSamples(1));
    running.signal(SIGHUP);
    const ProgramResult result = running.wait();
    EXPECT_EQ(result.exitCode, 130) << result.err;
    EXPECT_TRUE(fs::exists(dir / "a.exr"));
}

TEST_F(HostileFiles, AFileSizeLimitIsAFailureThatLeavesNothing) {
    const ProgramResult result = shell("ulimit -f 8; \"$W\" bake ink -o f.vdb --resolution 32 -q");
    EXPECT_EQ(result.exitCode, 1) << result.err;
    EXPECT_NE(result.err.find("File too large"), std::string::npos) << result.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), fs::directory_iterator()), 2);
}

TEST_F(HostileFiles, TooLittleMemoryIsSeenBeforeRendering) {
    // Above what starting takes, below what the film and its encoding need.
    ProgramLimits limits;
    limits.addressSpace = std::size_t{1} << 30;
    const ProgramResult result =
        runProgram({"render", file("s.toml"), "-o", file("a.exr"), "--res", "2000x2000",
                    "--threads", "2", "--layers", "depth,error,variance"},
                   limits);
    EXPECT_EQ(result.exitCode, 2) << result.err;
    EXPECT_NE(result.err.find("--res: 2000 x 2000 pixels need"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("complete"), std::string::npos) << result.err;
}

TEST_F(HostileFiles, ABakeWritesOverNothingThatItReads) {
    writeText(dir / "r.toml", recipe +
                                  "[node.n]\ntype = \"grid\"\nfile = \"in.vdb\"\n"
                                  "grid = \"density\"\n");
    fs::create_hard_link(dir / "in.vdb", dir / "hard.vdb");
    fs::create_symlink("in.vdb", dir / "link.vdb");
    fs::create_hard_link(dir / "in.vdb", dir / "out.lod1.vdb");
    const std::string before = readText(dir / "in.vdb");
    for (const std::string arguments :
         {"r.toml -o in.vdb", "r.toml -o hard.vdb", "r.toml -o link.vdb",
          "r.toml -o out.vdb --lod 1", "in.vdb -o hard.vdb", "ink -o in.vdb --like hard.vdb",
          "r.toml --write-recipe r.toml"}) {
        const ProgramResult result = shell("\"$W\" bake " + arguments + " -q");
        EXPECT_EQ(result.exitCode, 2) << arguments << result.err;
        EXPECT_NE(result.err.find("is an input and an output"), std::string::npos)
            << arguments << result.err;
    }
    EXPECT_EQ(readText(dir / "in.vdb"), before);
    EXPECT_FALSE(fs::exists(dir / "out.vdb"));
}

TEST_F(HostileFiles, ARecipeGoesToStdout) {
    const ProgramResult result = shell("\"$W\" bake ink --write-recipe -");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("[[output]]"), std::string::npos);
    EXPECT_FALSE(fs::exists(dir / "-"));
}

TEST_F(HostileFiles, AChangingSceneFileIsNoPlaceForAnImage) {
    writeImage(dir / "sky.exr", {});
    writeText(dir / "e.toml", scene + "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n");
    fs::create_hard_link(dir / "sky.exr", dir / "hard.exr");
    for (const char* out : {"sky.exr", "hard.exr"}) {
        const ProgramResult result = runProgram({"render", file("e.toml"), "-o", file(out)});
        EXPECT_EQ(result.exitCode, 2) << result.err;
    }
}

TEST_F(HostileFiles, ImagesAndConfigsThatNeverEndAreRefused) {
    ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
    fs::create_symlink("/dev/zero", dir / "zero");
    writeText(dir / "sparse", "");
    fs::resize_file(dir / "sparse", std::uintmax_t{1} << 40);
    const auto refused = [&](const std::vector<std::string>& arguments) {
        ProgramLimits limits;
        limits.seconds = 8;
        limits.addressSpace = std::size_t{4} << 30;
        const ProgramResult result = runProgram(arguments, limits);
        EXPECT_EQ(result.exitCode, 3) << fmt::format("{}", fmt::join(arguments, " ")) << result.err;
        EXPECT_NE(result.err.find("cannot read"), std::string::npos) << result.err;
        EXPECT_LT(result.residentBytes, std::size_t{300} << 20);
    };
    for (const std::string name : {"pipe", "zero", "sparse"}) {
        writeText(dir / "e.toml",
                  scene + "[[light]]\ntype = \"environment\"\nimage = \"" + name + "\"\n");
        refused({"render", file("e.toml"), "-o", file("o.exr")});
        writeText(dir / "t.toml",
                  scene + "[[material]]\nname = \"m\"\ntype = \"diffuse\"\ncolour = { image = \"" +
                      name + "\" }\n[[surface]]\nmaterial = \"m\"\nsphere = {}\n");
        refused({"render", file("t.toml"), "-o", file("o.exr")});
        writeText(dir / "c.toml", "ocio = \"" + name + "\"\n" + scene);
        refused({"render", file("c.toml"), "-o", file("o.png")});
        writeText(dir / "h.toml", recipe + "[node.n]\ntype = \"height_field\"\nimage = \"" + name +
                                      "\"\nsize = 1\n");
        refused({"bake", file("h.toml"), "-o", file("o.vdb"), "--resolution", "8"});
        refused({"compare", file(name), file(name)});
    }
}

TEST_F(HostileFiles, DeepNestingIsRefused) {
    const auto refused = [&](const std::vector<std::string>& arguments, const char* why) {
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, 3) << result.err.substr(0, 300);
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err.substr(0, 300);
        EXPECT_LT(result.err.size(), 2000u);
    };
    std::string key = "a";
    for (int i = 0; i < 40000; ++i) key += ".a";
    writeText(dir / "k.toml", scene + key + " = 1\n");
    refused({"render", file("k.toml"), "-o", file("o.exr")}, "a key has more than 32 parts");
    refused({"render", file("s.toml"), "-o", file("o.exr"), "--set", key + "=1"},
            "the key has more than 32 parts");
    refused({"render", file("s.toml"), "-o", file("o.exr"), "--set", "a={" + key + "=1}"},
            "a key has more than 32 parts");

    std::string chain = recipe, let = "[let]\n";
    for (int i = 0; i < 6000; ++i) {
        chain += fmt::format("[node.{0}]\ntype = \"abs\"\ninput = \"n{1}\"\n",
                             i == 0 ? "n" : fmt::format("n{}", i), i + 1);
        let += fmt::format("v{} = \"v{} + 1\"\n", i, i + 1);
    }
    writeText(dir / "c.toml", chain + "[node.n6000]\ntype = \"sphere\"\nradius = 1\n");
    refused({"bake", file("c.toml"), "-o", file("o.vdb")}, "nested more than 500 nodes deep");
    writeText(dir / "l.toml",
              let + "v6000 = 1\n" + recipe + "[node.n]\ntype = \"sphere\"\nradius = \"v0\"\n");
    refused({"bake", file("l.toml"), "-o", file("o.vdb")},
            "a chain of more than 100 other parameters");
    // Each warp of two warps is evaluated at its own moved points: 2^40 steps.
    std::string warps = recipe;
    for (int i = 0; i < 40; ++i)
        warps += fmt::format(
            "[node.{0}]\ntype = \"add\"\ninputs = [{{ type = \"transform\", input = "
            "\"n{1}\", translate = [1, 0, 0] }}, {{ type = \"transform\", input = "
            "\"n{1}\", translate = [0, 1, 0] }}]\n",
            i == 0 ? "n" : fmt::format("n{}", i), i + 1);
    writeText(dir / "w.toml", warps + "[node.n40]\ntype = \"sphere\"\nradius = 1\n");
    refused({"bake", file("w.toml"), "-o", file("o.vdb")}, "steps for each point");
}

TEST_F(HostileFiles, NamesDoNotDriveTheTerminal) {
    writeText(dir / "e.toml",
              scene +
                  "[[surface]]\nmaterial = \"\\u001b]0;title taken\\u0007\\u001b[31mred\"\n"
                  "sphere = {}\n");
    const ProgramResult result = runProgram({"render", file("e.toml"), "-o", file("o.exr")});
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("\\x1b]0;title taken\\x07\\x1b[31mred"), std::string::npos)
        << result.err;
    // Nor do names of files.
    const ProgramResult missing = runProgram({"info", file("\x1b[31m\xff.vdb")});
    EXPECT_EQ(missing.exitCode, 3);
    EXPECT_NE(missing.err.find("\\x1b[31m\\xff.vdb"), std::string::npos) << missing.err;
    fs::copy_file(dir / "in.vdb", dir / "\x1b[31m.vdb");
    const ProgramResult info = runProgram({"info", file("\x1b[31m.vdb")});
    EXPECT_EQ(info.exitCode, 0) << info.err;
    EXPECT_EQ(info.out.find('\x1b'), std::string::npos) << info.out;
}

}  // namespace
}  // namespace woodcock::test
