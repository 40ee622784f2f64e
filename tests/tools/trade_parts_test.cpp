// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/tools/run_trade.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

namespace {

using nlohmann::json;

constexpr const char* scene = R"(
[[volume]]
box = { min = [0, 0, 0], max = [1, 1, 1] }
sigma_a = 0.5
sigma_s = 2
[[light]]
type = "environment"
[render]
resolution = [32, 16]
)";

class TradeParts : public testing::Test {
protected:
    void SetUp() override { writeText(dir / "fog.toml", scene); }
    std::string file(const std::string& name) const { return (dir / name).string(); }
    void expectFailure(std::vector<std::string> arguments, int exitCode,
                       const std::vector<std::string>& said) const {
        arguments.insert(arguments.begin(), "trade");
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        for (const std::string& words : said)
            EXPECT_NE(result.err.find(words), std::string::npos)
                << "says:     " << result.err << "expected: " << words;
    }
    const TempDir dir;
};

TEST_F(TradeParts, NeedsAreMeasuredAndReported) {
    const ProgramResult result =
        runTrade({file("fog.toml"), "--needs", "--report", file("new/report")}, 10);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("three colour channels"), std::string::npos) << result.out;
    const json report = json::parse(readText(file("new/report/needs.json")));
    EXPECT_EQ(report.at("scene"), "fog.toml");
    EXPECT_TRUE(report.at("woodcock").contains("version"));
    EXPECT_TRUE(report.at("notes").is_array());
    ASSERT_EQ(report.at("rows").size(), 6u);
    for (const json& row : report.at("rows")) {
        const bool needed = row.at("need") == "scattering";
        EXPECT_EQ(row.at("needed"), needed) << row;
        if (needed) {
            EXPECT_EQ(row.at("verdict"), "needed");
            EXPECT_TRUE(row.at("ratio").is_null());
            continue;
        }
        for (const char* key : {"seconds", "pretended", "ratio"}) {
            EXPECT_GT(row.at(key).at("value"), 0.0) << row;
            EXPECT_GE(row.at(key).at("se"), 0.0) << row;
        }
        EXPECT_EQ(row.at("verdict"), row.at("cost").at("value") >= 1.1 ? "earns" : "does not earn");
        EXPECT_GT(row.at("variance").at("value"), 0.0) << row;
        const bool guard = row.at("need") == "emission";
        EXPECT_TRUE(row.at("same_bits") || !guard) << row;
    }
    const std::string csv = readText(file("new/report/needs.csv"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
}

TEST_F(TradeParts, ScalingIsMeasuredAndReported) {
    const ProgramResult result = runTrade({"--scaling", "--report", file("report")}, 10);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const json report = json::parse(readText(file("report/scaling.json")));
    std::vector<std::string> names;
    for (const json& curve : report.at("curves")) {
        names.push_back(curve.at("name"));
        EXPECT_FALSE(curve.at("x").at("label").get<std::string>().empty());
        EXPECT_FALSE(curve.at("y").at("label").get<std::string>().empty());
        for (const json& series : curve.at("series")) {
            EXPECT_TRUE(series.at("slope").contains("value")) << series;
            // Where the machine is too slow for that budget it says so.
            EXPECT_TRUE(!series.at("points").empty() || !report.at("notes").empty()) << series;
            for (const json& point : series.at("points")) {
                EXPECT_GT(point.at("x"), 0.0) << curve.at("name") << series;
                EXPECT_GT(point.at("y"), 0.0) << curve.at("name") << series;
            }
        }
    }
    for (const char* name :
         {"voxels", "optical depth", "albedo", "forward scattering", "overlapping volumes",
          "majorant cells", "threads", "load time", "memory", "random lookups"})
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
    for (const json& table : report.at("tables"))
        for (const json& row : table.at("rows"))
            EXPECT_EQ(row.size(), table.at("columns").size()) << table.at("title");
    const std::string csv = readText(file("report/scaling.csv"));
    EXPECT_EQ(csv.find("curve,series,x_label,x,y_label,y,se\n"), 0u);
}

TEST_F(TradeParts, MistakesCostNoTime) {
    expectFailure({"--needs"}, 2, {"there is no input"});
    expectFailure({"--needs", "--scaling"}, 2, {"--needs", "--scaling"});
    expectFailure({"--scaling", file("fog.toml")}, 2, {"makes its own scenes", "fog.toml"});
    expectFailure({"--scaling", "--budget", "1s"}, 2, {"budget", "too small", "10.0 s"});
    expectFailure({"--needs", file("fog.toml"), "--budget", "0.0001s"}, 2, {"too small"});
    expectFailure({"--needs", file("fog.toml"), "--budget", "soon"}, 2, {"--budget", "soon"});
    expectFailure({"--needs", file("missing.toml")}, 3, {"missing.toml"});
    writeText(file("taken"), "a file");
    expectFailure({"--needs", file("fog.toml"), "--report", file("taken")}, 2,
                  {"--report", "taken"});
    expectFailure({"--scaling", "--report", file("taken/below")}, 2, {"--report", "taken/below"});
}

}  // namespace
}  // namespace woodcock::test
