// SPDX-License-Identifier: Apache-2.0
#include "tools/render/estimate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;
using namespace tool;

namespace {

/// Student's t for 95 %, from published tables.
constexpr double t4 = 2.776445, t2 = 4.302653;

FrameTrial trial(int frame, double load, double render, double error) {
    return {.frame = frame,
            .loadSeconds = load,
            .renderSeconds = render,
            .standardError = error,
            .samples = 64,
            .sceneBytes = 1000,
            .fileBytes = 500};
}

TEST(Estimate, OfAllFramesHasTheErrorOfItsBlocksAlone) {
    const RenderEstimate e =
        estimateAll({trial(1, 1, 10, 0.3), trial(2, 1, 20, 0.4)}, 2, 5000, 500);
    EXPECT_DOUBLE_EQ(e.frame.value, 16);
    EXPECT_DOUBLE_EQ(e.all.value, 32);
    EXPECT_NEAR(e.all.error, t4 * 0.5, 1e-5);  // 0.5 is the root of 0.3^2 + 0.4^2
    EXPECT_NEAR(e.frame.error, t4 * 0.25, 1e-5);
    EXPECT_DOUBLE_EQ(e.memory.value, 5000 + 2 * 1000);  // two frames at once
}

TEST(Estimate, OfSomeFramesHasTheErrorOfTheSampleToo) {
    const RenderEstimate e =
        estimateAll({trial(1, 0, 10, 0), trial(5, 0, 13, 0), trial(9, 0, 16, 0)}, 12, 5000, 900);
    EXPECT_DOUBLE_EQ(e.all.value, 12 * 13);
    // Cochran 1977, eq. 2.20: a sample of 3 out of 12, of variance 9.
    EXPECT_NEAR(e.all.error, t2 * 12 * std::sqrt(9.0 / 3 * (1 - 3.0 / 12)), 1e-4);
    // The largest file is 900 bytes, of which 1800 of grids come.
    EXPECT_DOUBLE_EQ(e.memory.value, 5000 + 2 * 1800);
}

TEST(Estimate, CountsDenoisingInEachFrame) {
    const RenderEstimate e = estimateAll({trial(1, 1, 10, 0.3), trial(2, 1, 20, 0.4)}, 2, 5000, 500,
                                         {.value = 3, .error = 1.2});
    EXPECT_DOUBLE_EQ(e.frame.value, 16 + 3);
    EXPECT_DOUBLE_EQ(e.all.value, 2 * (16 + 3));
    EXPECT_NEAR(e.all.error, t4 * 2 * std::hypot(0.25, 1.2), 1e-4);  // both have the one error
    EXPECT_NEAR(e.denoising.error, t4 * 1.2, 1e-5);
    EXPECT_NE(estimateText(e).find("denoising takes 3"), std::string::npos) << estimateText(e);
    EXPECT_EQ(estimateJson(e).at("denoise_seconds").at("value"), 3);
}

TEST(Estimate, ScalesTimesByPixels) {
    const auto linear = [](int side) { return 0.5 + 1e-6 * side * side; };
    const Guess guess = timeByPixels(linear, 2e6);
    EXPECT_NEAR(guess.value, 2.5, 1e-9);
    EXPECT_NEAR(guess.error, 0, 1e-9);
    // Times that go up and down by 1 %: by formula, of 3 and 3 of them.
    int calls = 0;
    const Guess noisy =
        timeByPixels([&](int side) { return linear(side) * (1 + 0.01 * (calls++ % 3 - 1)); }, 2e6);
    const double p1 = 96 * 96, p2 = 288 * 288, k = (2e6 - p2) / (p2 - p1);
    EXPECT_NEAR(noisy.value, 2.5, 1e-9);
    EXPECT_NEAR(noisy.error,
                0.01 / std::sqrt(3) * std::hypot((1 + k) * linear(288), k * linear(96)), 1e-9);
}

TEST(Estimate, TriesFramesAllOver) {
    std::vector<int> frames;
    for (int n = 1; n <= 100; ++n) frames.push_back(n);
    EXPECT_EQ(spreadFrames(frames, 5), (std::vector{11, 31, 51, 71, 91}));
    EXPECT_EQ(spreadFrames({7, 9}, 5), (std::vector{7, 9}));
    EXPECT_TRUE(spreadFrames({}, 5).empty());
}

TEST(Estimate, WritesNoPicture) {
    const TempDir dir;
    for (int n = 1; n <= 3; ++n) {
        GridSpec grid;
        grid.name = "density";
        grid.box = {{0, 0, 0}, {15, 15, 15}};
        grid.value = [](Vec3i) { return 0.5; };
        writeVdb(dir / fmt::format("s.{}.vdb", n), {grid});
    }
    const auto estimate = [&](std::vector<std::string> more) {
        std::vector<std::string> words{
            "render",    (dir / "s.#.vdb").string(), "--frames", "1-3", "--res", "32x16",
            "--estimate"};
        words.insert(words.end(), more.begin(), more.end());
        const ProgramResult result = runProgram(words);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 3);
        return result.out;
    };
    const auto json = nlohmann::json::parse(
        estimate({"--spp", "32", "--json", "-o", (dir / "x.#.exr").string()}));
    EXPECT_EQ(json.at("frames"), 3);
    ASSERT_EQ(json.at("trials").size(), 3u);
    EXPECT_EQ(json.at("trials")[2].at("frame"), 3);
    EXPECT_EQ(json.at("trials")[2].at("samples"), 32);
    EXPECT_NEAR(json.at("seconds").at("value"),
                3 * json.at("seconds_of_frame").at("value").get<double>(), 1e-6);
    EXPECT_GT(json.at("seconds").at("error"), 0);
    EXPECT_GT(json.at("memory_bytes").at("value"), 1e6);
    EXPECT_NE(estimate({"--time-limit", "1"}).find("3 frames: "), std::string::npos);
    // Noise falls with the root of the samples.
    const auto samples = [&](const char* noise) {
        return nlohmann::json::parse(estimate({"--spp", "1000000", "--noise", noise, "--json"}))
            .at("trials")[0]
            .at("samples")
            .get<double>();
    };
    EXPECT_NEAR(samples("1%") / samples("2%"), 4, 1);
}

}  // namespace
}  // namespace woodcock::test
