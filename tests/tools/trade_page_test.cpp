// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tools/trade/report_answers.h"
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

/// What the example's report says of its candidates, and the models that they are told to have.
TradeResult exampleResult(const json& report) {
    TradeResult result;
    for (const json& c : report.at("candidates")) {
        CandidateResult& candidate = result.candidates.emplace_back();
        TradeModel& model = candidate.model;
        model.biased = c.at("biased");
        if (c.at("costs").empty()) continue;
        candidate.loadSeconds = c.at("load_seconds");
        for (const json& p : c.at("points"))
            candidate.points.push_back({p.at("samples"), p.at("seconds"), {}, {}});
        model.secondsPerSample = c.at("seconds_per_sample").at("value");
        model.costs = c.at("costs").get<std::vector<double>>();
        if (!model.biased) continue;
        const double bias = c.at("rms_bias").at("value"), error = c.at("rms_bias").at("se");
        model.squaredBias = {bias * bias, 2 * bias * error + error * error};
    }
    for (const json& r : report.at("equal_time")) result.equalTime.push_back({r.at("seconds"), {}});
    for (const json& r : report.at("equal_error"))
        result.equalError.push_back({r.at("relmse"), {}});
    return result;
}

json exampleAnswers(const json& report) {
    return tool::answersJson(exampleResult(report), report.at("budget"));
}

std::string exampleTradePage(const json& report) {
    return tool::tradePage(report, exampleAnswers(report));
}

/// What the models say of one question: who is the best, who is tied, whom to take with how many
/// samples, and all that can, best first.
json expectedAnswer(const TradeResult& result, const std::string& kind, double target,
                    Counted counted, Among among) {
    const std::vector<TradeModel> models = result.models(counted);
    const bool inTime = kind == "time";
    json answer{{"kind", kind},
                {"target", target},
                {"loading", counted == Counted::LoadingToo},
                {"unbiased", among == Among::Unbiased},
                {"best", nullptr}};
    const auto winner = inTime ? bestAt(models, target, among) : fastestTo(models, target, among);
    if (!winner) return answer;
    std::vector<std::pair<double, std::size_t>> values;
    for (std::size_t i = 0; i < models.size(); ++i)
        if (among == Among::All || !models[i].biased)
            if (const auto v = inTime ? models[i].errorAt(target) : models[i].secondsTo(target))
                values.push_back({v->value, i});
    std::ranges::sort(values);
    json& order = answer["order"] = json::array();
    for (const auto& [value, i] : values) order.push_back(i);
    const TradeModel& taken = models[winner->recommended];
    answer["best"] = winner->best;
    answer["tied"] = winner->tied;
    answer["recommended"] = winner->recommended;
    answer["samples"] = inTime ? taken.samplesIn(target) : *taken.samplesTo(target);
    return answer;
}

/// Of two digits, as the page answers.
double twoDigits(double v) { return std::stod(fmt::format("{:.2g}", v)); }

/// For the script to compare with what the page shows.
json expectedAnswers(const json& report) {
    const TradeResult result = exampleResult(report);
    std::vector<double> times{0.05, 0.3, 1, 10, 100, 1e5}, errors{1e-1, 1e-2, 3e-3, 1e-3, 1e-9};
    for (int i = 0; i < 24; ++i) times.push_back(twoDigits(0.5 * std::pow(40, i / 23.0)));
    json all = json::array();
    for (const Counted counted : {Counted::Rendering, Counted::LoadingToo})
        for (const Among among : {Among::All, Among::Unbiased}) {
            for (const double t : times)
                all.push_back(expectedAnswer(result, "time", t, counted, among));
            for (const double e : errors)
                all.push_back(expectedAnswer(result, "error", e, counted, among));
        }
    return all;
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

// What is known of each target: the models' own numbers, to the digits that are written.
TEST(TradePages, HoldTheModelsAnswers) {
    const json report = exampleReports().at("trade");
    const TradeResult result = exampleResult(report);
    const json answers = exampleAnswers(report);
    for (const std::string kind : {"time", "error"})
        for (const Counted counted : {Counted::Rendering, Counted::LoadingToo}) {
            const std::vector<TradeModel> models = result.models(counted);
            const json& all = answers.at(kind);
            const auto targets = all.at("targets").get<std::vector<double>>();
            const json& weighed =
                all.at(counted == Counted::Rendering ? "rendering" : "with_loading");
            for (std::size_t t = 0; t < targets.size(); ++t) {
                SCOPED_TRACE(fmt::format("{} {}", kind, targets[t]));
                for (const auto& [name, among] :
                     {std::pair{"all", Among::All}, std::pair{"unbiased", Among::Unbiased}}) {
                    const json expected = expectedAnswer(result, kind, targets[t], counted, among);
                    for (const char* key : {"best", "tied", "recommended", "samples"})
                        EXPECT_EQ(weighed.at(name).at(key).at(t), expected.value(key, json()));
                }
                for (std::size_t i = 0; i < models.size(); ++i) {
                    const auto v = kind == "time" ? models[i].errorAt(targets[t])
                                                  : models[i].secondsTo(targets[t]);
                    const json &value = weighed.at("value").at(i).at(t),
                               &error = weighed.at("se").at(i).at(t);
                    ASSERT_EQ(value.is_number(), v.has_value());
                    if (!v) continue;
                    EXPECT_NEAR(value.get<double>(), v->value, 1e-4 * v->value);
                    EXPECT_NEAR(error.get<double>(), v->se, 0.06 * v->se);
                }
            }
        }
    EXPECT_TRUE(answers.at("cost").back().is_null()) << "it was not measured";
    EXPECT_EQ(answers.at("cost").at(0), result.candidates[0].model.cost());
}

// In a real browser; what is done there, and what is expected, stands in the script. Which
// candidate each answer names is the models' word.
TEST(TradePages, WorkInABrowser) {
    const TempDir dir;
    for (const auto& [name, page, report] : examplePages()) writeText(dir / (name + ".html"), page);
    writeText(dir / "answers.json", expectedAnswers(exampleReports().at("trade")).dump());
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
