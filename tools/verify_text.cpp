// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "verify_report.h"
#include "woodcock/base/version.h"

namespace woodcock::tool {

using namespace proof;

std::string casesText(const std::string& check, const std::vector<Case>& cases) {
    std::string text = fmt::format("{}\n  {:<64} {:>12} {:>12} {:>9} {:>6}  verdict\n", check,
                                   "case", "expected", "measured", "error", "z");
    for (const Case& c : cases) {
        text += fmt::format("  {:<64} {:>12.6g} {:>12.6g} {:>9.1e} {:>6.2f}  {}\n", c.name,
                            c.expected, c.measured, c.standardError, c.z(), nameOf(c.verdict()));
        if (c.verdict() != Verdict::Pass && !c.note.empty())
            text += fmt::format("    {}\n", c.note);
    }
    return text;
}

std::string summaryText(const std::vector<Case>& cases) {
    std::string text;
    const auto count = [&](Kind kind, auto&& which) {
        return std::count_if(cases.begin(), cases.end(),
                             [&](const Case& c) { return c.kind == kind && which(c.verdict()); });
    };
    for (const Kind kind : kinds) {
        const auto all = count(kind, [](Verdict) { return true; });
        const auto passed = count(kind, [](Verdict v) { return v == Verdict::Pass; });
        text += fmt::format("{:<12} {:>4} cases, {:>4} pass{}\n", nameOf(kind), all, passed,
                            passed == all ? "" : fmt::format(", {} DO NOT", all - passed));
    }
    return text;
}

std::string reportJson(const VerifyReport& report) {
    using Json = nlohmann::ordered_json;
    Json cases = Json::array();
    for (const Case& c : report.cases) {
        Json j{{"kind", nameOf(c.kind)},          {"case", c.name},
               {"expected", c.expected},          {"allowance", c.allowance},
               {"measured", c.measured},          {"standard_error", c.standardError},
               {"largest_error", c.largestError}, {"z", c.z()},
               {"verdict", nameOf(c.verdict())}};
        if (!c.note.empty()) j["note"] = c.note;
        if (!c.curve.empty()) j["curve"] = c.curve, j["x_name"] = c.xName, j["x"] = c.x;
        cases.push_back(std::move(j));
    }
    Json volumes = Json::array();
    for (const auto& file : report.options.volumes) volumes.push_back(file.string());
    return Json{{"version", version()},        {"full", report.options.full},
                {"seed", report.options.seed}, {"volumes", volumes},
                {"complete", report.complete}, {"cases", cases}}
               .dump(2) +
           "\n";
}

}  // namespace woodcock::tool
