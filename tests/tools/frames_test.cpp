// SPDX-License-Identifier: Apache-2.0
// Sequences: --frames of the commands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Runs in a directory of its own that holds s.0009.vdb to s.0012.vdb; 11 is the largest.
class Frames : public testing::Test {
protected:
    void SetUp() override {
        for (int n = 9; n <= 12; ++n) {
            GridSpec grid;
            grid.name = "density";
            grid.box = {{0, 0, 0}, {15, n == 11 ? 30 : n, 15}};
            grid.value = [n](Vec3i p) { return 0.5 + 0.03 * p.x + 0.1 * n; };
            writeVdb(dir / fmt::format("s.{:04}.vdb", n), {grid});
        }
    }
    std::string file(const std::string& name) const { return (dir / name).string(); }
    ProgramResult render(const std::string& input, const Words& more) const {
        Words arguments{"render", file(input), "--res", "16x8", "--threads", "2"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(arguments);
    }
    ProgramResult renderScene(const std::string& text, const Words& more) const {
        writeText(dir / "scene.toml", text);
        return render("scene.toml", more);
    }
    std::vector<float> pixels(const std::string& name) const { return readBack(dir / name).values; }

    static void expectSaid(const ProgramResult& result, int exitCode, const Words& said) {
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        for (const std::string& words : said)
            EXPECT_NE(result.err.find(words), std::string::npos)
                << "says:     " << result.err << "expected: " << words;
    }

    const TempDir dir;
    const std::string lit =
        "[[light]]\ntype = \"environment\"\n"
        "[camera]\neye = [8, 8, 60]\nlook_at = [8, 8, 8]\n[render]\nspp = 2\n";
    std::string sequence(const std::string& keys = "") const {
        return "[[volume]]\nfile = \"s.####.vdb\"\nscale = 0.1\n" + keys + "\n" + lit;
    }
};

TEST_F(Frames, EqualSingleRunsBitForBit) {
    const ProgramResult all = render("s.####.vdb", {"--frames", "9-11,12", "--spp", "2", "-o",
                                                    file("a.####.exr"), "-o", file("a.%d.png")});
    expectSaid(all, 0, {"chosen from the largest file of", "s.0011.vdb", "frame 12, 4 of 4"});
    for (int n = 9; n <= 12; ++n) {
        const std::string one = fmt::format("one.{}", n);
        ASSERT_EQ(render(fmt::format("s.{:04}.vdb", n),
                         {"--spp", "2", "-o", file(one + ".exr"), "-o", file(one + ".png")})
                      .exitCode,
                  0);
        EXPECT_EQ(pixels(fmt::format("a.{:04}.exr", n)), pixels(one + ".exr"));
        EXPECT_EQ(pixels(fmt::format("a.{}.png", n)), pixels(one + ".png"));
    }
    ASSERT_EQ(render("s.####.vdb", {"--frame", "12.7", "--spp", "2", "-o", file("c.exr")}).exitCode,
              0);
    EXPECT_EQ(pixels("c.exr"), pixels("one.12.exr"));
    // Scenes with all patterns, and quiet ones.
    for (const char* pattern : {"%04d", "$F4", "<frame04>"}) {
        std::string text = sequence();
        text.replace(text.find("####"), 4, pattern);
        ASSERT_EQ(renderScene(text, {"--frames", "10", "-q", "-o", file("b.####.exr")}).exitCode,
                  0);
        ASSERT_EQ(renderScene(sequence(), {"--set", "volume[0].file=" + file("s.0010.vdb"), "-o",
                                           file("one.exr")})
                      .exitCode,
                  0);
        EXPECT_EQ(pixels("b.0010.exr"), pixels("one.exr")) << pattern;
    }
}

TEST_F(Frames, ShowWhatTheRulesSay) {
    const auto frame = [&](int number, const std::string& keys) {
        const ProgramResult result = renderScene(
            sequence(keys), {"--frames", std::to_string(number), "-o", file("x.####.exr")});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return pixels(fmt::format("x.{:04}.exr", number));
    };
    const auto nine = frame(9, ""), eleven = frame(11, ""), twelve = frame(12, "");
    EXPECT_NE(nine, twelve);
    EXPECT_EQ(frame(5, "outside = \"hold\""), nine);
    EXPECT_EQ(frame(13, "outside = \"repeat\""), nine);
    EXPECT_EQ(frame(13, "outside = \"ping_pong\""), eleven);
    EXPECT_EQ(frame(1, "offset = 8"), nine);
    EXPECT_EQ(frame(101, "frame_start = 101\noffset = 8"), nine);
    // Black is the sky alone, as an empty grid is.
    const auto black = frame(13, "outside = \"black\"");
    writeVdb(dir / "empty.vdb", {GridSpec{}});
    ASSERT_EQ(renderScene("[[volume]]\nfile = \"empty.vdb\"\nscale = 0.1\n" + lit,
                          {"-o", file("empty.exr")})
                  .exitCode,
              0);
    EXPECT_EQ(black, pixels("empty.exr"));
    fs::remove(dir / "s.0010.vdb");
    EXPECT_EQ(frame(10, "missing = \"hold\""), nine);
    EXPECT_EQ(frame(10, "missing = \"black\""), black);
}

TEST_F(Frames, OneFailureDoesNotStopTheRest) {
    writeText(dir / "s.0010.vdb", "no VDB");
    const ProgramResult result =
        renderScene(sequence(), {"--frames", "8-11", "--json", "-o", file("x.####.exr")});
    expectSaid(
        result, 1,
        {"frame 8: ", "its files go from 9 to 12", "frame 10: ", "2 of 4 frames failed: 8,10"});
    EXPECT_TRUE(fs::exists(dir / "x.0009.exr") && fs::exists(dir / "x.0011.exr"));
    EXPECT_FALSE(fs::exists(dir / "x.0008.exr") || fs::exists(dir / "x.0010.exr"));
    const auto json = nlohmann::json::parse(result.out);
    ASSERT_EQ(json.at("frames").size(), 2u);
    EXPECT_EQ(json.at("frames")[1].at("frame"), 11);
    EXPECT_EQ(json.at("frames")[1].at("files")[0], file("x.0011.exr"));
    EXPECT_EQ(json.at("failed"), nlohmann::json({8, 10}));
    // One frame has a code of its own.
    expectSaid(renderScene(sequence(), {"--frames", "10", "-o", file("x.####.exr")}), 3,
               {"s.0010.vdb is not a VDB file"});
}

TEST_F(Frames, ThatAreThereAreLeftOut) {
    writeText(dir / "x.0009.exr", "kept");
    const Words options{"--frames", "9-10", "--skip-existing", "-o", file("x.####.exr")};
    expectSaid(renderScene(sequence(), options), 0, {"frame 9: there already", "frame 10, 1 of 1"});
    EXPECT_EQ(readText(dir / "x.0009.exr"), "kept");
    expectSaid(renderScene(sequence(), options), 0, {"frames 9-10: there already"});
    expectSaid(render("s.0009.vdb", {"--skip-existing", "-o", file("x.0009.exr")}), 0,
               {"is there already: nothing to do"});
}

TEST_F(Frames, WrongOnesAreNamed) {
    const auto wrong = [&](const std::string& input, const Words& more, int code, Words said) {
        const auto before = std::distance(fs::directory_iterator(dir.path()), {});
        expectSaid(render(input, more), code, said);
        EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), {}), before);
    };
    const std::string out = file("x.####.png");
    wrong("s.####.vdb", {"--frames", "9-10", "-o", file("x.png")}, 2,
          {"there are 2 frames and one file", "'" + file("x.####.png") + "'"});
    wrong("s.####.vdb", {"--frames", "9", "-o", file("x.{frame}.png")}, 2,
          {"{frame} is not filled in"});
    wrong("s.####.vdb", {"-o", out}, 2, {"--frames 9-12 -o", "stands for a frame's number"});
    wrong("s.0009.vdb", {"-o", out}, 2, {"no frames are asked for"});
    wrong("s.0009.vdb", {"--frames", "9-10", "-o", out}, 2,
          {"would be read for every frame", file("s.####.vdb")});
    wrong("none.####.vdb", {"--frames", "9", "-o", out}, 3,
          {"there is no file '" + file("none.####.vdb") + "' with a frame's number"});
    wrong("s.####.vdb", {"--frames", "1-8", "-o", out}, 3, {"its files go from 9 to 12"});
    wrong("s.####.vdb", {"--frames", "5-1x-1", "-o", out}, 2, {"the step is -1"});
    wrong("s.####.vdb", {"--frames", "1-9y1", "-o", out}, 2, {"leaves no frame"});
    wrong("s.####.vdb", {"--frames", "9", "--progress", "alfred", "--json", "-o", out}, 2,
          {"both print on stdout"});
}

TEST_F(Frames, OneSceneIsSavedForAll) {
    ASSERT_EQ(render("s.####.vdb", {"--write-scene", file("shot.toml")}).exitCode, 0);
    const Words frames{"--frames", "9,12", "--spp", "2", "-o", file("a.####.exr")};
    ASSERT_EQ(render("shot.toml", frames).exitCode, 0);
    const auto nine = pixels("a.0009.exr"), twelve = pixels("a.0012.exr");
    ASSERT_EQ(render("s.####.vdb", frames).exitCode, 0);
    EXPECT_EQ(pixels("a.0009.exr"), nine);
    EXPECT_EQ(pixels("a.0012.exr"), twelve);
}

TEST_F(Frames, MayHaveSceneFilesOfTheirOwn) {
    for (int n = 1; n <= 2; ++n)
        writeText(dir / fmt::format("shot.{:04}.toml", n),
                  fmt::format("[[volume]]\nfile = \"s.{:04}.vdb\"\nscale = {}\n", 10 + n, n) + lit);
    const ProgramResult all =
        render("shot.####.toml", {"--frames", "1-3", "-o", file("x.####.exr")});
    expectSaid(all, 1, {"shot.0003.toml", "1 of 3 frames failed: 3"});
    ASSERT_EQ(render("shot.0002.toml", {"-o", file("one.exr")}).exitCode, 0);
    EXPECT_EQ(pixels("x.0002.exr"), pixels("one.exr"));
}

TEST_F(Frames, TellFarmsHowFarTheyAre) {
    const auto lines = [&](const char* style) {
        return renderScene(sequence(),
                           {"--frames", "9-10", "--progress", style, "-o", file("x.####.exr")})
            .out;
    };
    const std::string alfred = lines("alfred");
    EXPECT_NE(alfred.find("ALF_PROGRESS 50%\n"), alfred.npos) << alfred;
    EXPECT_TRUE(alfred.ends_with("ALF_PROGRESS 100%\n")) << alfred;
    const std::string openjd = lines("openjd");
    EXPECT_NE(openjd.find("openjd_status: frame 10 (2 of 2)\n"), openjd.npos) << openjd;
    EXPECT_TRUE(openjd.ends_with("openjd_progress: 100.0\n")) << openjd;
    fs::remove(dir / "s.0010.vdb");
    EXPECT_NE(lines("openjd").find("openjd_fail: 1 of 2 frames failed: 10\n"), std::string::npos);
}

TEST_F(Frames, AnInterruptLeavesWholeFrames) {
    // The second frame has no end, so that the signal comes while it is drawn.
    std::string endless = lit;
    endless.replace(endless.find("spp = 2"), 7, "spp = 1000000000");
    for (const int n : {1, 2, 3})
        writeText(dir / fmt::format("shot.{:04}.toml", n),
                  "[[volume]]\nfile = \"s.0009.vdb\"\nscale = 0.1\n" + (n == 2 ? endless : lit));
    RunningProgram running({"render", file("shot.####.toml"), "--frames", "1-3", "--res", "16x8",
                            "-o", file("x.####.exr")});
    EXPECT_NE(running.awaitLine("wrote"), "");
    running.signal(SIGTERM);
    const ProgramResult result = running.wait();
    expectSaid(result, 130, {"interrupted: ", " done: 1"});
    EXPECT_FALSE(pixels("x.0001.exr").empty());
    EXPECT_FALSE(fs::exists(dir / "x.0002.exr"));
    for (const auto& entry : fs::directory_iterator(dir.path()))
        EXPECT_EQ(entry.path().filename().string().find("tmp"), std::string::npos) << entry.path();
}

TEST_F(Frames, AreBakedConvertedComparedAndShown) {
    const ProgramResult info =
        runProgram({"info", file("s.####.vdb"), "--frames", "9-10,13", "--json"});
    EXPECT_EQ(info.exitCode, 1);
    const auto files = nlohmann::json::parse(info.out).at("files");
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[1].at("file"), file("s.0010.vdb"));

    ASSERT_EQ(runProgram({"bake", file("s.####.vdb"), "--frames", "9,12", "--voxel", "1", "-o",
                          file("b.<frame>.vdb")})
                  .exitCode,
              0);
    EXPECT_TRUE(fs::exists(dir / "b.9.vdb") && fs::exists(dir / "b.12.vdb"));

    const Words convert{"convert", file("s.####.vdb"), file("c.$F4.nrrd"), "--frames", "9-12x3"};
    const ProgramResult converted = runProgram(convert);
    ASSERT_EQ(converted.exitCode, 0) << converted.err;
    EXPECT_TRUE(fs::exists(dir / "c.0009.nrrd") && fs::exists(dir / "c.0012.nrrd"));
    expectSaid(runProgram({"convert", file("s.####.vdb"), file("c.nrrd"), "--frames", "9"}), 2,
               {"put ####"});
    expectSaid(runProgram({"convert", file("s.####.vdb"), file("c.####.nrrd"), "--frames", "8-9"}),
               1, {"frame 8: ", "1 of 2 frames failed: 8"});

    ASSERT_EQ(renderScene(sequence(),
                          {"--frames", "9-10", "-o", file("x.####.exr"), "-o", file("y.####.exr")})
                  .exitCode,
              0);
    const ProgramResult compared =
        runProgram({"compare", file("x.####.exr"), file("y.####.exr"), "--frames", "9-11",
                    "--fail-above", "rmse=0", "--json"});
    expectSaid(compared, 1, {"frame 11: ", "1 of 3 frames failed: 11"});
    EXPECT_EQ(nlohmann::json::parse(compared.out).at("frames")[1].at("frame"), 10);
}

}  // namespace
}  // namespace woodcock::test
