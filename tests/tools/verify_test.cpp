// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"
#include "tools/verify/report.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;
using namespace tool;

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using proof::Case;
using proof::Kind;

constexpr const char* nasty = "a < b & \"c\" </script><script>alert(1)</script>";

tool::VerifyReport exampleReport() {
    tool::VerifyReport report;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    report.cases = {{.kind = Kind::Slab,
                     .name = "reflectance",
                     .expected = 0.5,
                     .measured = 0.503,
                     .standardError = 0.002,
                     .largestError = 0.005,
                     .note = "table",
                     .curve = "reflectance at g 0",
                     .xName = "optical depth",
                     .x = 2},
                    {.kind = Kind::Property, .name = nasty, .expected = 1, .measured = 2},
                    {.kind = Kind::Extreme, .name = "sigma 1e12", .expected = 1, .measured = nan}};
    report.options.volumes = {"caf\xe9.vdb"};  // no UTF-8
    report.times = {{Kind::Slab, "table of slabs", 3}, {Kind::Property, "furnace", 1}};
    report.date = "2000-01-02T03:04:05Z";
    return report;
}

TEST(VerifyReport, JsonHasEveryFieldOfEveryCase) {
    const json report = json::parse(tool::reportJson(exampleReport()));
    for (const char* key : {"version", "build", "threads", "date", "full", "seed", "volumes",
                            "complete", "largest_z", "seconds", "checks"})
        EXPECT_TRUE(report.contains(key)) << key;
    EXPECT_EQ(report.at("seconds"), 4);
    const json& cases = report.at("cases");
    ASSERT_EQ(cases.size(), 3u);
    const json& first = cases[0];
    EXPECT_EQ(first.at("kind"), "slab");
    EXPECT_EQ(first.at("case"), "reflectance");
    EXPECT_EQ(first.at("expected"), 0.5);
    EXPECT_EQ(first.at("measured"), 0.503);
    EXPECT_EQ(first.at("standard_error"), 0.002);
    EXPECT_NEAR(first.at("z"), 1.5, 1e-9);
    EXPECT_EQ(first.at("verdict"), "pass");
    EXPECT_EQ(first.at("note"), "table");
    EXPECT_EQ(first.at("curve"), "reflectance at g 0");
    EXPECT_EQ(first.at("x_name"), "optical depth");
    EXPECT_EQ(first.at("x"), 2);
    EXPECT_EQ(cases[1].at("case"), nasty);
    EXPECT_TRUE(cases[1].at("z").is_null());
    EXPECT_TRUE(cases[2].at("measured").is_null());
    EXPECT_EQ(cases[2].at("verdict"), "FAIL");
}

TEST(VerifyReport, PageHoldsTheReportAndNeedsNothingElse) {
    const tool::VerifyReport report = exampleReport();
    const std::string page = tool::reportHtml(report);
    for (const char* outside : {"http:", "https:", "src=", "@import", "url("})
        EXPECT_EQ(page.find(outside), std::string::npos) << outside;
    // The data end where the first end tag is: no name may hold one.
    const std::string begin = "<script type=\"application/json\" id=\"report\">";
    const std::size_t from = page.find(begin);
    ASSERT_NE(from, std::string::npos);
    const std::size_t start = from + begin.size(), end = page.find("</script", start);
    const std::string data = page.substr(start, end - start);
    EXPECT_EQ(data.find('<'), std::string::npos);
    EXPECT_EQ(json::parse(data), json::parse(tool::reportJson(report)));
    EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
    EXPECT_EQ(page.substr(0, 15), "<!doctype html>");
    EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");
}

TEST(VerifyReport, TextLinesUpWhateverTheNames) {
    std::vector<Case> cases = exampleReport().cases;
    cases[1].name = std::string(90, 'n');
    cases[2].name = "\xcf\x83 1e12";  // a sigma, two bytes wide
    std::istringstream lines(tool::casesText("check", cases));
    std::vector<std::size_t> ends;
    for (std::string line; std::getline(lines, line);) {
        std::size_t width = 0;
        for (const char c : line) width += (c & 0xc0) != 0x80;
        if (line.find("pass") != std::string::npos || line.find("FAIL") != std::string::npos)
            ends.push_back(width);
    }
    EXPECT_EQ(ends, std::vector<std::size_t>(3, ends.at(0)));
}

TEST(VerifyReport, SummaryCountsByKindAndTime) {
    const std::string text = tool::summaryText(exampleReport());
    EXPECT_NE(text.find("slab            1 cases,    1 pass"), std::string::npos) << text;
    EXPECT_NE(text.find("75 % of the time"), std::string::npos) << text;
    EXPECT_NE(text.find("1 DO NOT"), std::string::npos) << text;
}

class Verify : public testing::Test {
protected:
    std::string file(const std::string& name) const { return (dir / name).string(); }
    void expectFailure(std::vector<std::string> arguments, int exitCode,
                       const std::vector<std::string>& said) const {
        arguments.insert(arguments.begin(), "verify");
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        EXPECT_EQ(result.out, "");
        for (const std::string& words : said)
            EXPECT_NE(result.err.find(words), std::string::npos)
                << "says:     " << result.err << "expected: " << words;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
    const TempDir dir;
};

TEST_F(Verify, RunsChosenChecksAndWritesTheReport) {
    const ProgramResult result = runProgram(
        {"verify", "--only", "width of slabs", "--report", file("new/report"), "--seed", "3"});
    EXPECT_EQ(result.exitCode, 0) << result.out << result.err;
    EXPECT_EQ(result.err, fmt::format("info: wrote {} and {}\n", file("new/report/verify.json"),
                                      file("new/report/verify.html")));
    EXPECT_NE(result.out.find("width of slabs\n"), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("table of slabs"), std::string::npos) << result.out;
    const json report = json::parse(readText(file("new/report/verify.json")));
    EXPECT_EQ(report.at("seed"), 3);
    EXPECT_EQ(report.at("only"), "width of slabs");
    EXPECT_EQ(report.at("complete"), true);
    EXPECT_EQ(report.at("checks").size(), 1u);
    ASSERT_GT(report.at("cases").size(), 0u);
    const std::string page = readText(file("new/report/verify.html"));
    for (const json& c : report.at("cases")) {
        EXPECT_EQ(c.at("kind"), "slab");
        EXPECT_NE(page.find(c.at("case").get<std::string>()), std::string::npos);
    }
}

TEST_F(Verify, JsonOnStdoutIsTheReport) {
    const ProgramResult result = runProgram({"verify", "--only", "width of slabs", "--json"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_GT(json::parse(result.out).at("cases").size(), 0u);
}

TEST_F(Verify, WhatItCannotUseCostsNoTime) {
    expectFailure({"--quick", "--full"}, 2, {"--quick", "--full"});
    expectFailure({"--only", "no such check"}, 2, {"'no such check'", "table of slabs (slab)"});
    writeText(file("taken"), "a file");
    expectFailure({"--report", file("taken")}, 2, {"--report", "taken"});
    expectFailure({"--report", file("taken/below")}, 2, {"--report", "taken/below"});
    expectFailure({file("missing.vdb")}, 3, {"missing.vdb", "does not exist"});
    writeText(file("text.vdb"), "not a volume at all");
    expectFailure({file("text.vdb")}, 3, {"text.vdb", "is not a VDB file"});
}

TEST_F(Verify, AnInterruptionWritesWhatIsThere) {
    RunningProgram running({"verify", "--full", "--report", file("report")});
    while (!fs::exists(file("report"))) sched_yield();  // from then on it catches signals
    running.signal(SIGINT);
    EXPECT_EQ(running.wait().exitCode, 130);
    EXPECT_EQ(json::parse(readText(file("report/verify.json"))).at("complete"), false);
    EXPECT_TRUE(fs::exists(file("report/verify.html")));
}

}  // namespace
}  // namespace woodcock::test
