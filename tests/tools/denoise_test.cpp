// SPDX-License-Identifier: Apache-2.0
// `woodcock render --denoise` and `woodcock merge --denoise` with a library that denoises nothing,
// but does what can be computed: see tests/programs/fake_oidn.cpp.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/environment_variable.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/tools/fog_scene.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

using namespace proof;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class DenoiseOption : public testing::Test {
protected:
    void SetUp() override { writeWholeFile(dir / "fog.toml", fogScene()); }

    std::string file(const std::string& name) const { return (dir / name).string(); }
    ProgramResult run(Words words, const Words& more) const {
        words.insert(words.end(), more.begin(), more.end());
        return runProgram(words);
    }
    ProgramResult render(const Words& more) const {
        return run({"render", file("fog.toml"), "--spp", "8", "--threads", "2"}, more);
    }
    void expectDone(const ProgramResult& result) const {
        EXPECT_EQ(result.exitCode, 0) << result.err;
    }
    void expectRefused(const ProgramResult& result, int exitCode, const std::string& said) const {
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        EXPECT_NE(result.err.find(said), std::string::npos)
            << "says:     " << result.err << "expected: " << said;
        for (const fs::directory_entry& entry : fs::directory_iterator(dir.path()))
            EXPECT_EQ(entry.path().extension(), ".toml") << entry.path();
    }

    const TempDir dir;
    const EnvironmentVariable library{"WOODCOCK_OIDN", fakeOidn().string()};
};

/// What the library makes of a pixel of a file with the layers noisy, albedo and normal.
float denoised(const ReadBack& image, int x, int y, int channel) {
    const std::string rgb = "RGB", xyz = "XYZ";
    const auto c = static_cast<std::size_t>(channel);
    return image.at(x, y, std::string("noisy.") + rgb[c]) +
           image.at(x, y, std::string("albedo.") + rgb[c]) / 2 +
           image.at(x, y, std::string("normal.") + xyz[c]) / 4;
}

void expectDenoised(const ReadBack& image) {
    for (int y = image.y; y < image.y + image.height; ++y)
        for (int x = image.x; x < image.x + image.width; ++x)
            for (int c = 0; c < 3; ++c)
                ASSERT_EQ(image.at(x, y, std::string(1, "RGB"[c])), denoised(image, x, y, c))
                    << x << ", " << y << ", " << c;
}

/// These channels of one picture are those of the other.
void expectSame(const ReadBack& a, const Words& channelsOfA, const ReadBack& b,
                const Words& channelsOfB) {
    ASSERT_EQ(a.width, b.width);
    for (std::size_t c = 0; c < channelsOfA.size(); ++c)
        for (int y = a.y; y < a.y + a.height; ++y)
            for (int x = a.x; x < a.x + a.width; ++x)
                ASSERT_EQ(a.at(x, y, channelsOfA[c]), b.at(x, y, channelsOfB[c]))
                    << channelsOfA[c] << " at " << x << ", " << y;
}

const Words rgb{"R", "G", "B"}, noisyRgb{"noisy.R", "noisy.G", "noisy.B"};

TEST_F(DenoiseOption, KeepsTheNoisyPictureBesideIt) {
    expectDone(render({"-o", file("plain.exr"), "--layers", "albedo,normal,error"}));
    const ProgramResult result =
        render({"-o", file("a.exr"), "--denoise", "--layers", "albedo,normal,error,variance"});
    expectDone(result);
    EXPECT_NE(result.err.find("by Open Image Denoise 2.7.1"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("layers of noise are left out"), std::string::npos) << result.err;
    const ReadBack plain = readBack(file("plain.exr")), a = readBack(file("a.exr"));
    EXPECT_EQ(a.channels, (Words{"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "noisy.R",
                                 "noisy.G", "noisy.B", "normal.X", "normal.Y", "normal.Z"}));
    expectDenoised(a);
    expectSame(a, noisyRgb, plain, rgb);
    expectSame(a, {"A", "albedo.R", "normal.Z"}, plain, {"A", "albedo.R", "normal.Z"});
    EXPECT_EQ(a.attributes.at("woodcock/denoiser"), "Open Image Denoise 2.7.1");
    EXPECT_EQ(a.attributes.at("woodcock/denoised"),
              "R, G and B: HDR, with filtered albedo and normal. As rendered: the layer noisy");
    EXPECT_FALSE(a.attributes.contains("woodcock/noise"));
    EXPECT_EQ(a.attributes.at("woodcock/noiseBeforeDenoising"),
              plain.attributes.at("woodcock/noise"));
    EXPECT_EQ(a.attributes.at("woodcock/sceneDigest"), plain.attributes.at("woodcock/sceneDigest"))
        << "the same samples";
    EXPECT_FALSE(plain.attributes.contains("woodcock/denoiser"));
}

TEST_F(DenoiseOption, HasAPartOfItsOwnAndItsPrecision) {
    expectDone(render({"-o", file("a.exr"), "--denoise", "--multipart", "--half"}));
    const ReadBack picture = readBack(file("a.exr")), noisy = readBack(file("a.exr"), 1);
    EXPECT_EQ(picture.channels, (Words{"R", "G", "B", "A"}));
    EXPECT_EQ(noisy.channels, rgb);
    EXPECT_EQ(noisy.types.at("R"), "half");
    EXPECT_EQ(noisy.attributes.at("oiio:subimagename"), "noisy");
    EXPECT_NE(picture.values, noisy.values);
}

TEST_F(DenoiseOption, PicturesAreDenoisedToo) {
    expectDone(render({"-o", file("plain.png"), "-o", file("plain.exr")}));
    expectDone(render({"-o", file("a.png"), "-o", file("a.exr"), "--denoise"}));
    const ReadBack plain = readBack(file("plain.png")), a = readBack(file("a.png"));
    const ReadBack linear = readBack(file("a.exr"));
    double brighter = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            if (linear.at(x, y, "R") > linear.at(x, y, "noisy.R")) {
                EXPECT_GE(a.at(x, y, "R"), plain.at(x, y, "R"));
                brighter += double{a.at(x, y, "R")} - double{plain.at(x, y, "R")};
            }
    EXPECT_GT(brighter, 0);
}

TEST_F(DenoiseOption, ACropIsDenoisedInItsPlace) {
    expectDone(render(
        {"-o", file("a.exr"), "--denoise", "--layers", "albedo,normal", "--crop", "3,5,20,9"}));
    const ReadBack a = readBack(file("a.exr"));
    EXPECT_EQ(a.x, 3);
    EXPECT_EQ(a.height, 4);
    expectDenoised(a);
}

TEST_F(DenoiseOption, AdaptiveSamplesMattesAndGroupsAreAsTheyWere) {
    writeWholeFile(dir / "fog.toml", std::string(fogScene()) + "[output]\nmattes = [\"object\"]\n");
    const Words both{"--adaptive", "--layers", "volume_direct,samples"};
    Words with = both;
    with.insert(with.end(), {"--denoise", "-o", file("a.exr")});
    expectDone(render(with));
    Words without = both;
    without.insert(without.end(), {"-o", file("plain.exr")});
    expectDone(render(without));
    const ReadBack plain = readBack(file("plain.exr")), a = readBack(file("a.exr"));
    expectSame(a, noisyRgb, plain, rgb);
    const Words more{"A", "volume_direct.R", "samples", "CryptoObject00.r", "CryptoObject00.g"};
    expectSame(a, more, plain, more);
}

TEST_F(DenoiseOption, ASequenceIsDenoisedFrameByFrame) {
    const ProgramResult result =
        render({"-o", file("a.##.exr"), "--frames", "1-2", "--denoise", "--layers", "albedo,normal",
                "--stats", file("stats.json")});
    expectDone(result);
    for (const char* frame : {"a.01.exr", "a.02.exr"}) expectDenoised(readBack(file(frame)));
    const auto stats = nlohmann::json::parse(readText(file("stats.json")));
    for (const auto& frame : stats.at("frames")) {
        EXPECT_EQ(frame.at("denoiser"), "Open Image Denoise 2.7.1");
        EXPECT_GT(frame.at("denoise_seconds"), 0);
    }
}

TEST_F(DenoiseOption, WithoutALibraryNothingIsRendered) {
    const EnvironmentVariable none("WOODCOCK_OIDN", file("none"));
    const std::string said = "WOODCOCK_OIDN names '" + file("none") + "', which is not there\n";
    expectRefused(render({"-o", file("a.exr"), "--denoise"}), 2, "error: --denoise: " + said);
    writeWholeFile(dir / "fog.toml", std::string(fogScene()) + "denoise = true\n");
    expectRefused(render({"-o", file("a.exr")}), 2,
                  "error: " + file("fog.toml") + ":16:11: " + said);
    expectDone(render({"-o", file("a.exr"), "--no-denoise"}));
    EXPECT_FALSE(readBack(file("a.exr")).has("noisy.R"));
}

TEST_F(DenoiseOption, WhereItIsLookedForIsSaid) {
    // An environment without any; a machine may have one in the folders of its system.
    const EnvironmentVariable unset("WOODCOCK_OIDN", {}), home("HOME", dir.path().string()),
        path("PATH", "/nowhere"), environment("VIRTUAL_ENV", file("venv")),
        conda("CONDA_PREFIX", {});
    const ProgramResult result = render({"-o", file("a.exr"), "--denoise"});
    if (result.exitCode == 0) GTEST_SKIP() << "Open Image Denoise is installed in the system";
    expectRefused(result, 2,
                  "error: --denoise: Open Image Denoise is not installed: 'pip install pyoidn' "
                  "brings it; or let WOODCOCK_OIDN name libOpenImageDenoise.so.2, or its folder");
    expectRefused(result, 2,
                  "below " + file("venv") + ", " + file(".local") + ", /usr/local, /usr");
}

TEST_F(DenoiseOption, ALibraryThatDoesNotWorkIsRefusedFirst) {
    const EnvironmentVariable wrong("FAKE_OIDN", "version");
    expectRefused(render({"-o", file("a.exr"), "--denoise"}), 2,
                  "is Open Image Denoise 3.7.1, and version 2 is needed");
}

TEST_F(DenoiseOption, WhatFailsInTheEndKeepsThePicture) {
    expectDone(render({"-o", file("plain.exr")}));
    const EnvironmentVariable wrong("FAKE_OIDN", "filter");
    const ProgramResult result = render({"-o", file("a.exr"), "--denoise"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.err.find("error: Open Image Denoise fails: the weights are lost. The picture "
                              "is written as it was rendered, without being denoised\n"),
              std::string::npos)
        << result.err;
    const ReadBack plain = readBack(file("plain.exr")), a = readBack(file("a.exr"));
    EXPECT_EQ(a.channels, plain.channels);
    EXPECT_EQ(a.values, plain.values);
    EXPECT_FALSE(a.attributes.contains("woodcock/denoiser"));
}

TEST_F(DenoiseOption, PartsAreRefusedAndSayWhatToDo) {
    for (const Words& part : {Words{"--tile", "0/2"}, {"--samples", "0:4"}}) {
        Words all{"render", file("fog.toml"), "-o", file("a.exr"), "--denoise"};
        all.insert(all.end(), part.begin(), part.end());
        expectRefused(runProgram(all), 2,
                      "error: --denoise: " + part[0] +
                          " draws a part of a picture, and only a whole picture is denoised");
    }
}

TEST_F(DenoiseOption, MergedPartsAreDenoised) {
    const Words layers{"--layers", "albedo,normal,error"};
    for (const auto& [range, name] : {std::pair("0:4", "p0.exr"), {"4:8", "p1.exr"}})
        expectDone(run({"render", file("fog.toml"), "--quality", "preview", "--no-adaptive",
                        "--samples", range, "-o", file(name)},
                       layers));
    EXPECT_FALSE(readBack(file("p0.exr")).has("noisy.R")) << "a quality denoises no parts";
    const Words merge{"merge", file("p0.exr"), file("p1.exr")};
    expectDone(run(merge, {"-o", file("plain.exr")}));
    expectDone(run(merge, {"-o", file("a.exr"), "--denoise"}));
    const ReadBack plain = readBack(file("plain.exr")), a = readBack(file("a.exr"));
    expectDenoised(a);
    expectSame(a, noisyRgb, plain, rgb);
    EXPECT_TRUE(plain.has("error.R"));
    EXPECT_FALSE(a.has("error.R"));
    EXPECT_EQ(a.attributes.at("woodcock/denoiser"), "Open Image Denoise 2.7.1");

    expectDone(
        run({"render", file("fog.toml"), "--spp", "2"}, {"--mergeable", "-o", file("bare.exr")}));
    const ProgramResult bare =
        runProgram({"merge", file("bare.exr"), "-o", file("b.exr"), "--denoise"});
    EXPECT_EQ(bare.exitCode, 2);
    EXPECT_NE(bare.err.find("render them with --layers albedo,normal"), std::string::npos)
        << bare.err;
}

TEST_F(DenoiseOption, SumsStayAsTheyWereRendered) {
    const Words layers{"--denoise", "--layers", "albedo,normal"};
    expectDone(run({"render", file("fog.toml"), "--spp", "4", "--mergeable", "-o", file("a.exr")},
                   layers));
    expectDone(runProgram({"merge", file("a.exr"), "-o", file("plain.exr")}));
    expectSame(readBack(file("a.exr")), noisyRgb, readBack(file("plain.exr")), rgb);

    fs::copy_file(file("a.exr"), file("b.checkpoint.exr"));
    expectDone(
        run({"render", file("fog.toml"), "--spp", "8", "--resume", "-o", file("b.exr")}, layers));
    EXPECT_FALSE(fs::exists(file("b.checkpoint.exr")));
    expectDone(run({"render", file("fog.toml"), "--spp", "8", "-o", file("c.exr")}, layers));
    const ReadBack resumed = readBack(file("b.exr")), whole = readBack(file("c.exr"));
    expectDenoised(resumed);
    EXPECT_EQ(resumed.values, whole.values);
}

TEST_F(DenoiseOption, PreviewDenoisesWhereItCan) {
    const Words preview{"-o", file("a.exr"), "--quality", "preview"};
    const ProgramResult with = render(preview);
    expectDone(with);
    EXPECT_TRUE(readBack(file("a.exr")).has("noisy.R"));
    EXPECT_NE(with.err.find("pictures are denoised, as Open Image Denoise 2.7.1 is installed"),
              std::string::npos)
        << with.err;
    const EnvironmentVariable none("WOODCOCK_OIDN", file("none"));
    const ProgramResult without = render(preview);
    expectDone(without);
    EXPECT_FALSE(readBack(file("a.exr")).has("noisy.R"));
    EXPECT_EQ(without.err.find("enois"), std::string::npos) << without.err;
}

TEST_F(DenoiseOption, ABrokenLibraryDoesNotStopAPreview) {
    const EnvironmentVariable wrong("FAKE_OIDN", "device");
    const ProgramResult result = render({"-o", file("a.exr"), "--quality", "preview"});
    expectDone(result);
    EXPECT_FALSE(readBack(file("a.exr")).has("noisy.R"));
    EXPECT_NE(result.err.find("pictures are not denoised: "), std::string::npos) << result.err;
}

TEST_F(DenoiseOption, ASavedSceneSaysWhatWasAskedFor) {
    const auto saved = [&](const Words& more) {
        Words all{"--write-scene", file("saved.toml"), "-o", file("a.exr")};
        all.insert(all.end(), more.begin(), more.end());
        expectDone(render(all));
        const std::string text = readText(file("saved.toml"));
        const std::size_t at = text.find("denoise");
        return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
    };
    EXPECT_EQ(saved({}), "");
    EXPECT_EQ(saved({"--denoise"}), "denoise = true");
    EXPECT_EQ(saved({"--quality", "preview"}), "denoise = \"if_installed\"");
}

}  // namespace
}  // namespace woodcock::test
