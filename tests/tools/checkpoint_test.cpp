// SPDX-License-Identifier: Apache-2.0
// Renders that are interrupted, killed and resumed, and parts that are merged, as users do it.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/tools/fog_scene.h"
#include "woodcock/image/film_state.h"
#include "woodcock/image/read_layers.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class Checkpoints : public testing::Test {
protected:
    void SetUp() override { writeText(dir / "fog.toml", fogScene()); }

    std::string file(const std::string& name) const { return (dir / name).string(); }
    Words words(const Words& more, const std::string& out = "a.exr",
                const std::string& layers = "depth,error,samples") const {
        Words all{"render", file("fog.toml"), "-o", file(out)};
        if (!layers.empty()) all.insert(all.end(), {"--layers", layers});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    ProgramResult render(const Words& more, const std::string& out = "a.exr",
                         const std::string& layers = "depth,error,samples") const {
        return runProgram(words(more, out, layers));
    }
    /// Pictures with the same numbers in every channel.
    void expectSame(const std::string& a, const std::string& b) const {
        const LayeredImage one = readLayers(dir / a), other = readLayers(dir / b);
        ASSERT_EQ(one.planes.size(), other.planes.size());
        for (std::size_t i = 0; i < one.planes.size(); ++i)
            EXPECT_EQ(one.planes[i].values, other.planes[i].values) << one.planes[i].name();
    }
    static void expectSaid(const ProgramResult& result, int exitCode, const Words& said) {
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        for (const std::string& text : said)
            EXPECT_NE(result.err.find(text), std::string::npos)
                << "says:     " << result.err << "expected: " << text;
    }
    const TempDir dir;
};

/// So many samples that no machine draws them all before it is interrupted.
const std::string endless = "1000000000";

/// SIGUSR1 writes one and goes on; after kill -9 the picture becomes what it would have been.
TEST_F(Checkpoints, SurviveKill) {
    RunningProgram program(words({"--spp", endless, "--progress", "json", "--threads", "1"}));
    EXPECT_TRUE(program.awaitSamples(1));
    program.signal(SIGUSR1);
    EXPECT_FALSE(program.awaitLine("a.checkpoint.exr").empty());
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait().exitCode, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(dir / "a.exr"));

    // A picture that viewers open, of some samples.
    const ReadBack shown = readBack(dir / "a.checkpoint.exr");
    EXPECT_EQ(shown.width, 24);
    EXPECT_GT(shown.at(12, 12, "samples"), 0);

    // A few more than are there, however many the machine has drawn.
    float most = 0;
    for (const float samples : readLayers(dir / "a.checkpoint.exr").find("samples")->values)
        most = std::max(most, samples);
    const std::string spp = std::to_string(static_cast<int>(most) + 40);
    EXPECT_EQ(render({"--spp", spp}, "whole.exr").exitCode, 0);
    expectSaid(render({"--spp", spp, "--resume"}), 0, {"goes on from"});
    expectSame("whole.exr", "a.exr");
    EXPECT_FALSE(fs::exists(dir / "a.checkpoint.exr"));
    expectSaid(render({"--spp", "2", "--resume"}), 0, {"begins anew"});
}

class CheckpointSignals : public Checkpoints, public testing::WithParamInterface<int> {};

TEST_P(CheckpointSignals, WriteAndEnd) {
    // The plan of adaptive samples follows from their number, which so is the same before and
    // after. A fast machine may have drawn it before it is interrupted; then it draws more.
    ProgramResult stopped;
    int spp = 500;
    do {
        spp *= 4;
        RunningProgram program(words({"--spp", std::to_string(spp), "--adaptive", "--progress",
                                      "json", "--threads", "1", "--checkpoint", "1h"}));
        program.awaitSamples(1);
        program.signal(GetParam());
        stopped = program.wait();
    } while (stopped.exitCode == 0);
    expectSaid(stopped, 130, {"a.checkpoint.exr", "--resume goes on from it"});
    EXPECT_TRUE(fs::exists(dir / "a.exr"));  // what was rendered so far
    const Words range{"--spp", std::to_string(spp), "--adaptive"};
    EXPECT_EQ(render(range, "whole.exr").exitCode, 0);
    EXPECT_EQ(render({"--spp", std::to_string(spp), "--adaptive", "--resume"}).exitCode, 0);
    expectSame("whole.exr", "a.exr");
}

INSTANTIATE_TEST_SUITE_P(Signals, CheckpointSignals, testing::Values(SIGINT, SIGTERM));

TEST_F(Checkpoints, AreWrittenEverySoOften) {
    RunningProgram program(
        words({"--spp", endless, "--progress", "json", "--checkpoint", "0.1s"}, "a.png", ""));
    EXPECT_TRUE(program.awaitSamples(1));
    for (int i = 0; i < 2; ++i) EXPECT_FALSE(program.awaitLine("a.checkpoint.exr").empty());
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait().exitCode, 130);
    EXPECT_GT(StateFile(dir / "a.checkpoint.exr", "checkpoint").count("end", 0, 1000000000), 0);
}

TEST_F(Checkpoints, OfOtherScenesAreRefusedByBothDigests) {
    RunningProgram program(words({"--spp", endless, "--progress", "json", "--checkpoint", "1h"}));
    EXPECT_TRUE(program.awaitSamples(2));
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait().exitCode, 130);
    const std::string digest = StateFile(dir / "a.checkpoint.exr", "checkpoint").fact("scene");
    const auto refuse = [&](const Words& more, const Words& said,
                            const char* layers = "depth,error,samples") {
        Words all{"--resume", "--spp", endless};
        all.insert(all.end(), more.begin(), more.end());
        expectSaid(render(all, "a.exr", layers), 3, said);
    };
    refuse({"--set", "volume[0].scale=2"},
           {"cannot go on from '" + file("a.checkpoint.exr") + "': it is of another scene",
            "its digest is " + digest, "and that of this render"});
    refuse({"--seed", "5"}, {"the seed is '0' there and '5' here"});
    refuse({}, {"sampled for layers is 'depth' there"}, "depth,normal");
    refuse({"--tile", "0/2"}, {"it has the pixels 0,0,24,24 of 24 x 24, and asked for are"});
    expectSaid(render({"--resume", "--spp", "1"}), 2, {"and only 0:1 are asked for"});

    const std::string bytes = readText(dir / "a.checkpoint.exr");
    writeText(dir / "a.checkpoint.exr", bytes.substr(0, bytes.size() / 2));
    refuse({}, {"cannot read checkpoint '" + file("a.checkpoint.exr") + "': it is damaged"});
    writeText(dir / "a.checkpoint.exr", "");
    refuse({}, {"cannot read checkpoint", "it is empty"});
    EXPECT_TRUE(fs::exists(dir / "a.checkpoint.exr"));  // whoever wants it gone removes it
}

TEST_F(Checkpoints, NeedAFileBesideWhichTheyLie) {
    expectSaid(
        runProgram({"render", file("fog.toml"), "--write-scene", file("b.toml"), "--resume"}), 2,
        {"--resume is for a render"});
    expectSaid(render({"--checkpoint", "soon"}), 2, {"--checkpoint: 'soon' is not a duration"});
    expectSaid(render({"-o", file("a.checkpoint.exr"), "--checkpoint", "1h"}), 2,
               {"a.checkpoint.exr' is named twice as an output"});
    expectSaid(render({"--resume", "--quality", "auto", "--noise", "1%"}), 2,
               {"--quality auto and --resume contradict each other"});
}

class Merge : public Checkpoints {
protected:
    ProgramResult merge(const Words& parts, const Words& more = {}) const {
        Words all{"merge"};
        for (const std::string& part : parts) all.push_back(file(part));
        all.insert(all.end(), {"-o", file("merged.exr")});
        all.insert(all.end(), more.begin(), more.end());
        return runProgram(all);
    }
    /// Tiles and ranges of samples: part0.exr to part3.exr.
    void makeParts() const {
        for (const auto& [i, tile, range] : {std::tuple(0, "0/2", "0:5"),
                                             {1, "0/2", "5:16"},
                                             {2, "1/2", "0:5"},
                                             {3, "1/2", "5:16"}})
            EXPECT_EQ(
                render({"--tile", tile, "--samples", range}, "part" + std::to_string(i) + ".exr")
                    .exitCode,
                0);
    }
};

TEST_F(Merge, PartsAreOnePicture) {
    makeParts();
    const ReadBack tile = readBack(dir / "part2.exr");
    EXPECT_EQ(tile.fullWidth, 24);
    EXPECT_EQ(tile.width * tile.height, 24 * 12);
    EXPECT_EQ(render({"--spp", "16", "-o", file("whole.png")}, "whole.exr").exitCode, 0);
    const ProgramResult result = merge({"part3.exr", "part0.exr", "part2.exr", "part1.exr"},
                                       {"-o", file("merged.png"), "--spp", "16", "--json"});
    expectSaid(result, 0, {"4 parts, 16 to 16 samples per pixel"});
    const nlohmann::json told = nlohmann::json::parse(result.out);
    EXPECT_EQ(told["end_sample"], 16);
    EXPECT_EQ(told["missing"].size(), 0u);

    const LayeredImage whole = readLayers(dir / "whole.exr"),
                       merged = readLayers(dir / "merged.exr");
    ASSERT_EQ(whole.planes.size(), merged.planes.size());
    for (std::size_t i = 0; i < whole.planes.size(); ++i) {
        EXPECT_EQ(whole.planes[i].name(), merged.planes[i].name());
        for (std::size_t p = 0; p < whole.planes[i].values.size(); ++p) {
            // To a float's last place, or to the rounding of sums where samples are all alike.
            const float a = whole.planes[i].values[p], b = merged.planes[i].values[p];
            EXPECT_TRUE(std::abs(a - b) <= std::nextafter(std::abs(a), 1e30f) - std::abs(a) ||
                        (std::abs(a) < 1e-6f && std::abs(b) < 1e-6f))
                << whole.planes[i].name() << ": " << a << ", " << b;
        }
    }
    for (const char* fact : {"woodcock/samples", "woodcock/sampleRange", "woodcock/sceneDigest"})
        EXPECT_EQ(whole.facts.at(fact), merged.facts.at(fact)) << fact;
    const LayeredImage wholePng = readLayers(dir / "whole.png"),
                       mergedPng = readLayers(dir / "merged.png");
    for (std::size_t i = 0; i < wholePng.planes.size(); ++i)
        EXPECT_EQ(wholePng.planes[i].values, mergedPng.planes[i].values);
}

/// Mattes and deep pixels of tiles and ranges of samples, and headers that only differ in how the
/// picture was made.
TEST_F(Merge, MattesDeepPixelsAndHeadersAreThoseOfOnePicture) {
    writeText(dir / "fog.toml", fogScene() + "fps = 25\n[[surface]]\nsphere = { radius = 0.3 }\n");
    const auto draw = [&](Words more, const std::string& name) {
        more.insert(more.end(),
                    {"--mattes", "object,material", "--deep", file(name + "_deep.exr")});
        EXPECT_EQ(render(more, name + ".exr").exitCode, 0);
    };
    draw({"--spp", "9"}, "whole");
    Words parts;
    for (const char* tile : {"0/2", "1/2"})
        for (const char* range : {"0:4", "4:9"}) {
            parts.push_back("part" + std::to_string(parts.size()) + ".exr");
            draw({"--tile", tile, "--samples", range}, "part" + std::to_string(parts.size() - 1));
        }
    ASSERT_EQ(merge(parts, {"--deep", file("merged_deep.exr")}).exitCode, 0);
    const ReadBack whole = readBack(dir / "whole.exr"), merged = readBack(dir / "merged.exr");
    EXPECT_EQ(whole.channels, merged.channels);
    ASSERT_TRUE(whole.has("CryptoMaterial02.a"));
    for (std::size_t i = 0; i < whole.values.size(); ++i)
        EXPECT_FLOAT_EQ(whole.values[i], merged.values[i]);
    const auto expectSameHeaders = [](std::map<std::string, std::string> a,
                                      std::map<std::string, std::string> b) {
        EXPECT_TRUE(a.contains("woodcock/commandLine"));
        for (const char* made : {"woodcock/commandLine", "woodcock/renderSeconds", "DateTime"})
            a.erase(made), b.erase(made);
        EXPECT_EQ(a, b);
    };
    for (const char* known : {"worldToCamera", "worldToNDC", "framesPerSecond"})
        EXPECT_TRUE(whole.attributes.contains(known)) << known;
    expectSameHeaders(whole.attributes, merged.attributes);

    // Bins have the same edges; points of the sphere may be grouped otherwise.
    OIIO::ImageBuf one(file("whole_deep.exr")), other(file("merged_deep.exr"));
    ASSERT_TRUE(one.read(0, 0, true) && other.read(0, 0, true));
    const OIIO::ImageBuf flat = OIIO::ImageBufAlgo::flatten(one),
                         flatMerged = OIIO::ImageBufAlgo::flatten(other);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x)
            for (int c = 0; c < 4; ++c)
                EXPECT_NEAR(flat.getchannel(x, y, 0, c), flatMerged.getchannel(x, y, 0, c), 1e-6);

    // Elsewhere, or left out.
    ASSERT_EQ(merge(parts, {"--mattes-file", file("m.exr")}).exitCode, 0);
    EXPECT_FALSE(readBack(dir / "merged.exr").has("CryptoObject00.r"));
    EXPECT_TRUE(readBack(dir / "m.exr").has("CryptoObject00.r"));
    EXPECT_EQ(render({"--mergeable", "--spp", "1"}, "plain.exr").exitCode, 0);
    expectSaid(merge({"plain.exr"}, {"--deep", file("d.exr")}), 2,
               {"--deep: the parts hold no deep pixels: they were rendered without --deep"});
    expectSaid(merge({"plain.exr"}, {"--mattes-file", file("d.exr")}), 2,
               {"--mattes-file: the parts hold no mattes"});
    EXPECT_FALSE(fs::exists(dir / "d.exr"));
}

TEST_F(Merge, SaysWhatDoesNotFit) {
    makeParts();
    const auto refuse = [&](const Words& parts, const std::string& said, const Words& more = {}) {
        expectSaid(merge(parts, more), 3, {said});
        EXPECT_FALSE(fs::exists(dir / "merged.exr"));
    };
    refuse({"part0.exr", "part1.exr", "part2.exr"},
           "samples 5:16 of 288 pixels in 0,12,24,24 are missing (seed 0)");
    refuse({"part0.exr", "part1.exr"},
           "samples 0:16 of 288 pixels in 0,12,24,24 are missing (seed 0)");
    refuse({"part0.exr", "part1.exr", "part2.exr", "part3.exr"},
           "samples 16:32 of all pixels are missing", {"--spp", "32"});
    EXPECT_EQ(render({"--samples", "3:9"}, "doubled.exr").exitCode, 0);
    refuse({"part0.exr", "doubled.exr"},
           "part0.exr' and '" + file("doubled.exr") +
               "' both hold samples 3:5 of 288 pixels in 0,0,24,12 (seed 0)");
    EXPECT_EQ(render({"--samples", "0:4", "--set", "volume[0].g=0"}, "other.exr").exitCode, 0);
    refuse({"part0.exr", "other.exr"}, "are of different scenes: their digests are ");
    EXPECT_EQ(render({"--spp", "4"}, "plain.exr").exitCode, 0);
    refuse({"plain.exr"}, "it keeps no sums, only a picture");
    EXPECT_EQ(render({"--samples", "5:16", "--tile", "0/2"}, "layers.exr", "depth").exitCode, 0);
    refuse({"part0.exr", "layers.exr"},
           "have different layers ('depth,error,samples' and 'depth')");
    expectSaid(merge({"part0.exr"}, {"--layers", "normal", "--partial"}), 2,
               {"the parts hold nothing of the layer 'normal'"});
    expectSaid(runProgram({"merge", file("part0.exr"), "-o", file("part0.exr")}), 2,
               {"is an input and an output"});
    expectSaid(merge({"part0.exr", "part1.exr"}, {"--partial"}), 0, {"are missing (seed 0)"});
    EXPECT_TRUE(fs::exists(dir / "merged.exr"));
}

TEST_F(Merge, AdaptiveRendersOfSeveralSeeds) {
    for (const char* seed : {"1", "2"})
        EXPECT_EQ(render({"--spp", "16", "--adaptive", "--mergeable", "--seed", seed},
                         std::string(seed) + ".exr")
                      .exitCode,
                  0);
    EXPECT_EQ(merge({"1.exr", "2.exr"}).exitCode, 0);
    const LayeredImage one = readLayers(dir / "1.exr"), two = readLayers(dir / "2.exr"),
                       both = readLayers(dir / "merged.exr");
    for (std::size_t p = 0; p < 24 * 24; ++p) {
        const float n = one.find("samples")->values[p], m = two.find("samples")->values[p];
        EXPECT_EQ(both.find("samples")->values[p], n + m);
        EXPECT_FLOAT_EQ(both.find("G")->values[p],
                        (n * one.find("G")->values[p] + m * two.find("G")->values[p]) / (n + m));
    }
}

}  // namespace
}  // namespace woodcock::test
