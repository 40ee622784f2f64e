// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/support/environment_variable.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/write_image.h"

namespace woodcock::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CompareCommand : public testing::Test {
protected:
    /// Light `mean` with normal noise, a name for each seed.
    std::string noisy(double mean, unsigned seed) const {
        ImageFile file;
        file.width = 64, file.height = 64;
        auto random = std::make_shared<std::mt19937>(seed);
        file.value = [mean, random](int, int, std::size_t) {
            return std::normal_distribution<double>(mean, 0.05)(*random);
        };
        return writeImage(dir / fmt::format("{}-{}.exr", mean, seed), file).string();
    }
    std::string file(const std::string& name) const { return (dir / name).string(); }
    std::string write(const std::string& name, const ImageFile& image) const {
        return writeImage(dir / name, image).string();
    }
    static ProgramResult run(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "compare");
        return runProgram(arguments);
    }
    void expectFailure(const std::vector<std::string>& arguments, int exitCode,
                       const std::vector<std::string>& said) const {
        std::vector<std::string> all = arguments;
        if (std::find(all.begin(), all.end(), "--report") == all.end())
            all.insert(all.end(), {"--report", file("report")});
        const ProgramResult result = run(all);
        const std::string line = fmt::format("{}", fmt::join(all, " "));
        EXPECT_EQ(result.exitCode, exitCode) << line << "\n" << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        for (const std::string& words : said)
            EXPECT_NE(result.err.find(words), std::string::npos)
                << line << "\nsays:     " << result.err << "expected: " << words;
        EXPECT_FALSE(fs::exists(file("report"))) << line;
    }

    const EnvironmentVariable noConfig{"OCIO", {}};
    const TempDir dir;
};

TEST_F(CompareCommand, TextSaysWhatDiffers) {
    const std::string a = noisy(0.5, 1), b = noisy(0.5, 2), c = noisy(0.508, 3);
    const ProgramResult result = run({a, b, c});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    for (const std::string words :
         {"64 x 64 pixels, 64 tiles; A is the reference", "\nB: same within noise",
          "\nC: differ: the mean of R, G, B", "false alarms 0.001", "FLIP: "})
        EXPECT_NE(result.out.find(words), std::string::npos) << words << "\n" << result.out;
}

TEST_F(CompareCommand, JsonHoldsTheNumbers) {
    const std::string a = noisy(0.5, 1), b = noisy(0.508, 2);
    const ProgramResult result = run({a, b, "--json", "--tile", "16", "--false-alarms", "0.01"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const json report = json::parse(result.out);
    EXPECT_EQ(report.at("tiles"), 16);
    EXPECT_EQ(report.at("tile_side"), 16);
    EXPECT_EQ(report.at("false_alarm_rate"), 0.01);
    EXPECT_EQ(report.at("images").at(0).at("files").at(0), a);
    const json& c = report.at("comparisons").at(0);
    EXPECT_EQ(c.at("image"), "B");
    EXPECT_EQ(c.at("verdict"), "differ");
    EXPECT_EQ(c.at("tests"), 3 * 17);
    const json& red = c.at("channels").at(0);
    EXPECT_EQ(red.at("name"), "R");
    const double error = 0.05 * std::sqrt(2.0) / 64;
    EXPECT_NEAR(red.at("bias"), 0.008, 4 * error);
    EXPECT_NEAR(red.at("bias_error"), error, 0.1 * error);
    EXPECT_NEAR(red.at("ratio"), 1.016, 8 * error);
    EXPECT_NEAR(red.at("rmse"), 0.05 * std::sqrt(2.0), 0.002);
    EXPECT_EQ(red.at("largest").size(), 5u);
}

TEST_F(CompareCommand, EqualImagesGiveNullWhereThereIsNoNumber) {
    const std::string a = noisy(0.5, 1);
    const json report = json::parse(run({a, a, "--json"}).out);
    EXPECT_TRUE(report.at("comparisons").at(0).at("channels").at(0).at("psnr").is_null());
}

TEST_F(CompareCommand, SeedsOfAnImage) {
    const ProgramResult result = run({noisy(0.5, 1), noisy(0.5, 2), "--more", "A=" + noisy(0.5, 3),
                                      "--more", "B=" + noisy(0.5, 4)});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("errors from 2 seeds"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("noise from standard errors"), std::string::npos) << result.out;
}

TEST_F(CompareCommand, FailAbove) {
    const std::string a = noisy(0.5, 1), b = noisy(0.5, 2), c = noisy(0.508, 3);
    EXPECT_EQ(run({a, b, "--fail-above", "differ", "--fail-above", "rmse=0.08", "--fail-above",
                   "non-finite=0"})
                  .exitCode,
              0);
    const ProgramResult differ = run({a, c, "--fail-above", "differ"});
    EXPECT_EQ(differ.exitCode, 1);
    EXPECT_NE(differ.err.find("B differs: the mean of R, G, B"), std::string::npos) << differ.err;
    const ProgramResult rmse = run({a, b, "--fail-above", "rmse=0.06"});
    EXPECT_EQ(rmse.exitCode, 1);
    EXPECT_NE(rmse.err.find("rmse of B is 0.07"), std::string::npos) << rmse.err;
    EXPECT_NE(rmse.out.find("same within noise"), std::string::npos) << "the table comes too";
    // Each metric fails where it is largest, and none for equal images.
    for (const std::string metric :
         {"bias", "ratio", "rmse", "relmse", "largest", "flip", "hdr-flip"}) {
        EXPECT_EQ(run({a, c, "--fail-above", metric + "=0"}).exitCode, 1) << metric;
        EXPECT_EQ(run({a, a, "--fail-above", metric + "=0"}).exitCode, 0) << metric;
    }
}

TEST_F(CompareCommand, NotANumberIsSaid) {
    ImageFile image;
    image.value = [](int x, int y, std::size_t) {
        return x == 3 && y == 2 ? std::numeric_limits<double>::quiet_NaN() : 0.5;
    };
    const ProgramResult result = run({write("a.exr", {}), write("b.exr", image), "--fail-above",
                                      "non-finite=0", "--report", file("report")});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.err.find("B holds 3 NaN or infinite values, the first one nan in R at 3, 2"),
              std::string::npos)
        << result.err;
    EXPECT_TRUE(fs::exists(file("report/compare.html")));
}

TEST_F(CompareCommand, TheReportIsTwoFiles) {
    const ProgramResult result =
        run({noisy(0.5, 1), noisy(0.508, 2), "--report", file("new/report")});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const json report = json::parse(readText(file("new/report/compare.json")));
    EXPECT_EQ(report.at("comparisons").at(0).at("verdict"), "differ");
    const std::string page = readText(file("new/report/compare.html"));
    EXPECT_EQ(page.find('@' + std::string("REPORT@")), std::string::npos);
    for (const char* network : {"http://", "https://", "src=", "import("})
        EXPECT_EQ(page.find(network), std::string::npos) << network;
}

TEST_F(CompareCommand, AFullDiskLeavesNoHalfReport) {
    const ProgramResult result = runProgram(
        {"compare", noisy(0.5, 1), noisy(0.5, 2), "--report", file("report")}, {.fileSize = 20000});
    EXPECT_EQ(result.exitCode, 1) << result.err;
    EXPECT_NE(result.err.find("compare.html"), std::string::npos) << result.err;
    for (const auto& entry : fs::directory_iterator(file("report")))
        EXPECT_EQ(entry.path().filename(), "compare.json");
}

TEST_F(CompareCommand, WhatCannotBeCompared) {
    const std::string a = write("a.exr", {});
    ImageFile other;
    other.width = 8;
    const std::string small = write("small.exr", other);
    other = {};
    other.channels = {"Z"};
    const std::string depth = write("depth.exr", other);
    writeText(file("text.exr"), "no image");
    other.channels = {"R"};
    other.value = [](int, int, std::size_t) { return std::numeric_limits<double>::infinity(); };
    const std::string infinite = write("infinite.exr", other);

    expectFailure({a, file("none.exr")}, 3, {"none.exr", "there is no such file"});
    expectFailure({a, file("text.exr")}, 3, {"text.exr"});
    expectFailure({a, small}, 3, {"is 16 x 12 pixels", "is 8 x 12", "--resample"});
    expectFailure({a, depth}, 3, {"no channel in common", "has R, G, B", "has Z"});
    expectFailure({a}, 2, {"2 to 26 images, not 1"});
    expectFailure({}, 2, {"nothing to compare"});
    expectFailure({a, a, "--more", "C=x.exr"}, 2, {"--more: 'C=x.exr'", "A to B"});
    expectFailure({a, a, "--more", "B=" + small}, 3, {"small.exr", "is not another seed of"});
    expectFailure({a, a, "--colour-space", "B=foo"}, 3, {"'foo'", "ACEScg"});
    expectFailure({a, a, "--fail-above", "rmes=1"}, 2, {"'rmes'", "did you mean 'rmse'"});
    expectFailure({a, a, "--fail-above", "rmse"}, 2, {"rmse needs a value"});
    expectFailure({a, a, "--fail-above", "rmse=-1"}, 2, {"rmse: '-1'"});
    expectFailure({a, a, "--tile", "1"}, 2, {"--tile: '1'"});
    expectFailure({a, a, "--false-alarms", "0"}, 2, {"--false-alarms: '0'"});
    expectFailure({a, a, "--ocio", file("none.ocio")}, 3, {"none.ocio"});
    expectFailure({a, a, "--report", file("text.exr")}, 2, {"--report", "text.exr"});
}

}  // namespace
}  // namespace woodcock::test
