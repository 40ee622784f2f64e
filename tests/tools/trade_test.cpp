// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/run_trade.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Bright fog: nearly all of its light is scattered several times.
const std::string fog = R"(
[[volume]]
box = { min = [-1, -1, -1], max = [1, 1, 1] }
sigma_s = 2
[[light]]
type = "environment"
visible = false
[camera]
eye = [0, 0, 4]
look_at = [0, 0, 0]
[render]
resolution = [24, 16]
)";
const std::string three = R"(
[[candidate]]
name = "plain"
[[candidate]]
name = "loose majorants, \"unbiased\""
set = ["render.majorant_scale=2"]
[[candidate]]
name = "one scattering"
set = ["render.max_scatterings=1"]
)";

class Trade : public testing::Test {
protected:
    void SetUp() override {
        writeText(dir / "fog.toml", fog);
        writeText(dir / "three.toml", three);
    }
    std::string file(const std::string& name) const { return (dir / name).string(); }
    void expectFailure(std::vector<std::string> arguments, int exitCode,
                       const std::string& said) const {
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_NE(result.err.find(said), std::string::npos)
            << "expected: " << said << "\nfound: " << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
    const TempDir dir;
};

/// The words of a command, of which none here holds a space.
std::vector<std::string> wordsOf(const std::string& command) {
    std::istringstream stream(command);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

void expectFields(const json& j, const std::vector<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(j.contains(key)) << key;
}

void expectEveryField(const json& report) {
    expectFields(report,
                 {"woodcock", "command", "scene", "digest", "resolution", "measured_resolution",
                  "threads", "budget", "seconds", "reference", "candidates", "front", "equal_time",
                  "equal_error", "recommendations", "crops", "notes"});
    expectFields(report.at("reference"),
                 {"samples", "seeds", "seconds", "relmse", "relmse_se", "mean", "mean_se"});
    for (const json& c : report.at("candidates")) {
        expectFields(c, {"name", "biased", "quality", "choices", "command", "paper", "load_seconds",
                         "memory", "seconds_per_sample", "cpu_seconds_per_sample", "bias",
                         "rms_bias", "variance", "points", "front", "crop"});
        for (const json& p : c.at("points"))
            expectFields(p, {"samples", "seconds", "relmse", "relmse_se", "flip", "flip_se"});
    }
    ASSERT_FALSE(report.at("recommendations").empty());
    ASSERT_FALSE(report.at("front").empty());
    ASSERT_EQ(report.at("crops").size(), 4u) << "the reference and three candidates";
}

TEST_F(Trade, FindsTheBiasThatIsThereAndNoOther) {
    const ProgramResult result = runTrade(
        {file("fog.toml"), "--candidates", file("three.toml"), "--report", file("report")}, 6);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);)
        if (line.find("woodcock render") == std::string::npos &&
            line.find("note:") == std::string::npos) {
            EXPECT_LE(line.size(), 100u) << line;
        }

    const json report = json::parse(readText(dir / "report/trade.json"));
    expectEveryField(report);
    const json& candidates = report.at("candidates");
    ASSERT_EQ(candidates.size(), 3u);
    for (const json& c : candidates) {
        SCOPED_TRACE(c.at("name"));
        const bool biased = c.at("name") == "one scattering";
        EXPECT_EQ(c.at("biased"), biased);
        const double bias = c.at("bias").at("value"), error = c.at("bias").at("se");
        EXPECT_EQ(std::abs(bias) > 4 * error, biased) << bias << " +- " << error;
        EXPECT_EQ(c.at("rms_bias").at("resolved"), biased);
        EXPECT_LT(error, 0.1) << "so that this means something";
    }
    const std::string csv = readText(dir / "report/trade.csv");
    EXPECT_NE(csv.find("\"loose majorants, \"\"unbiased\"\"\",false,"), std::string::npos) << csv;

    EXPECT_NE(readText(dir / "report/trade.html").find("data:image/png;base64,"),
              std::string::npos);

    const json& recommended = report.at("recommendations").back();
    EXPECT_EQ(recommended.at("kind"), "error");
    std::vector<std::string> words = wordsOf(recommended.at("command"));
    ASSERT_GT(words.size(), 6u);
    EXPECT_EQ(words[0], "woodcock");
    words.erase(words.begin());
    for (std::string& word : words)
        if (word == "fog.exr") word = file("fog.exr");
    words.back() = "2";  // samples
    EXPECT_EQ(runProgram(words).exitCode, 0);
    EXPECT_TRUE(fs::exists(dir / "fog.exr"));
}

TEST_F(Trade, MistakesAreOneClearLine) {
    const std::string scene = file("fog.toml");
    expectFailure({"trade", scene, "--budget", "1ms"}, 2, "--budget");
    expectFailure({"trade", scene, "--budget", "0.001s"}, 2, "is too small for");
    expectFailure({"trade", scene, "--candidates", file("none.toml")}, 3, "none.toml");
    writeText(dir / "bad.toml", "[[candidate]]\nname = \"a\"\nset = [\"camera.fov=3\"]\n");
    expectFailure({"trade", scene, "--candidates", file("bad.toml")}, 3, "bad.toml:3");
    writeText(dir / "twins.toml", "[[candidate]]\nname = \"a\"\n[[candidate]]\nname = \"b\"\n");
    expectFailure({"trade", scene, "--candidates", file("twins.toml")}, 3, "make the same");
    writeText(dir / "plain", "");
    expectFailure({"trade", scene, "--report", file("plain")}, 2, "--report");
    expectFailure({"trade", file("none.vdb")}, 3, "none.vdb");
}

TEST_F(Trade, InterruptedWritesNothing) {
    RunningProgram program({"trade", file("fog.toml"), "--budget", "100s", "--report",
                            file("report"), "--progress", "json"});
    EXPECT_NE(program.awaitLine("\"fraction\""), "");
    program.signal(SIGINT);
    EXPECT_EQ(program.wait().exitCode, 130);
    EXPECT_TRUE(fs::is_empty(dir / "report"));
}

TEST_F(Trade, QualityIsThatOfTheCommandLine) {
    const auto written = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"render", file("fog.toml"), "--write-scene", "-"});
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return result.out;
    };
    EXPECT_NE(written({"--quality", "draft"}).find("similarity_after = 1"), std::string::npos);
    const std::string set = written({"--set", "render.octaves=3", "--quality", "draft"});
    EXPECT_NE(set.find("octaves = 3"), std::string::npos) << set;
    expectFailure({"render", file("fog.toml"), "-o", file("a.exr"), "--quality", "drat"}, 2,
                  "did you mean 'draft'?");
}

TEST_F(Trade, AutoNeedsAGoalAndRendersByIt) {
    const std::string scene = file("fog.toml"), image = file("auto.exr");
    expectFailure({"render", scene, "-o", image, "--quality", "auto"}, 2,
                  "give --time-limit, such as 60s, or --noise");
    const ProgramResult result = runProgram(
        {"render", scene, "-o", image, "--quality", "auto", "--time-limit", "20s", "--spp", "4"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(fs::exists(image));
    const std::size_t at = result.err.find("the same again: ");
    ASSERT_NE(at, std::string::npos) << result.err;
    const std::string command = result.err.substr(at, result.err.find('\n', at) - at);
    EXPECT_NE(command.find(scene), std::string::npos) << command;
    EXPECT_EQ(command.find("auto "), std::string::npos) << command;
}

}  // namespace
}  // namespace woodcock::test
