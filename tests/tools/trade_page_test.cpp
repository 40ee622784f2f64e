// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tools/trade/report_html.h"
#include "woodcock/base/temp_dir.h"

namespace woodcock::test {

using namespace trade;

namespace {

using nlohmann::json;

/// Reports of all three kinds, whose names try to end their script, and where some things are null.
json exampleReports() {
    return json::parse(readText(sourceDir() / "tests/tools/trade_pages.json"));
}

/// The models that the example's candidates are told to have.
std::vector<TradeModel> exampleModels(const json& report) {
    std::vector<TradeModel> models;
    for (const json& c : report.at("candidates")) {
        TradeModel& model = models.emplace_back();
        if (c.at("costs").empty()) continue;
        model.secondsPerSample = c.at("seconds_per_sample").at("value");
        model.costs = c.at("costs").get<std::vector<double>>();
        if (!c.at("biased").get<bool>()) continue;
        const double bias = c.at("rms_bias").at("value"), error = c.at("rms_bias").at("se");
        model.squaredBias = {bias * bias, 2 * bias * error + error * error};
    }
    return models;
}

std::string exampleTradePage(const json& report) {
    return tool::tradePage(report, exampleModels(report));
}

struct MadePage {
    std::string name;
    std::string page;
    json report;
};

std::vector<MadePage> examplePages() {
    const json all = exampleReports();
    return {{"trade", exampleTradePage(all.at("trade")), all.at("trade")},
            {"scaling", tool::scalingPage(all.at("scaling")), all.at("scaling")},
            {"needs", tool::needsPage(all.at("needs")), all.at("needs")}};
}

/// The text of the page's data, up to the first end tag: where a browser ends them, too.
std::string dataIn(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"report\">";
    const std::size_t from = page.find(begin);
    if (from == std::string::npos) return "";
    const std::size_t start = from + begin.size();
    return page.substr(start, page.find("</script", start) - start);
}

TEST(TradePages, HoldTheReportAndNeedNothingElse) {
    for (const auto& [name, page, report] : examplePages()) {
        SCOPED_TRACE(name);
        // Of the page's own parts, url(#...) speaks.
        for (const char* outside : {"http:", "https:", " src=", "@import", "url(\"", "url('"})
            EXPECT_EQ(page.find(outside), std::string::npos) << outside;
        const std::string data = dataIn(page);
        EXPECT_EQ(data.find('<'), std::string::npos);
        EXPECT_EQ(json::parse(data), report);
        EXPECT_EQ(page.find("<script>window.pwned"), std::string::npos);
        EXPECT_EQ(page.substr(0, 15), "<!doctype html>");
        EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");
        for (const char* place : {"@TITLE@", "@STYLE@", "@DATA@", "@SCRIPT@"})
            EXPECT_EQ(page.find(place), std::string::npos) << place;
    }
}

TEST(TradePages, HoldWhatJsonCannotSay) {
    json report = exampleReports().at("trade");
    report["seconds"] = std::numeric_limits<double>::quiet_NaN();
    report["scene"] = "not UTF-8: \xff, and @DATA@";
    const json held = json::parse(dataIn(exampleTradePage(report)));
    EXPECT_TRUE(held.at("seconds").is_null());
    EXPECT_EQ(held.at("scene"), "not UTF-8: \xef\xbf\xbd, and @DATA@");
}

// In a real browser; what is done there, and what is expected, stands in the script.
TEST(TradePages, WorkInABrowser) {
    const TempDir dir;
    for (const auto& [name, page, report] : examplePages()) writeText(dir / (name + ".html"), page);
    const ProgramResult used =
        runProgram({"python3", (sourceDir() / "tests/programs/trade_page.py").string(),
                    (sourceDir() / "tests/tools/trade_pages.json").string(), dir.path().string()},
                   {}, "/usr/bin/env");
    if (used.exitCode == 77) GTEST_SKIP() << used.out;
    if (used.exitCode == 127) GTEST_SKIP() << "no python3 here";
    EXPECT_EQ(used.exitCode, 0) << used.out << used.err;
}

}  // namespace
}  // namespace woodcock::test
