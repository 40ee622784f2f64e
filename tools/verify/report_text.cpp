// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>

#include "tools/verify/report.h"
#include "woodcock/base/parse.h"

namespace woodcock::tool {

using namespace proof;

namespace {

constexpr std::size_t widestName = 64;

/// Letters, as a terminal counts them, not bytes.
std::size_t widthOf(const std::string& utf8) {
    return static_cast<std::size_t>(
        std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

std::string casesText(const std::string& check, const std::vector<proof::Case>& cases) {
    std::size_t column = 24;
    for (const proof::Case& c : cases)
        column = std::max(column, std::min(widthOf(c.name), widestName));
    std::string text = fmt::format("{}\n  {:<{}} {:>12} {:>12} {:>8} {:>6}  verdict\n", check,
                                   "case", column, "expected", "measured", "error", "z");
    for (const proof::Case& c : cases) {
        const std::size_t width = widthOf(c.name);
        text += "  " + c.name +
                (width > column ? "\n" + std::string(column + 2, ' ')
                                : std::string(column - width, ' '));
        text += fmt::format(" {:>12.6g} {:>12.6g} {:>8.1e} {:>6.2f}  {}\n", c.expected, c.measured,
                            c.standardError, c.z(), proof::nameOf(c.verdict()));
        if (c.verdict() != proof::Verdict::Pass && !c.note.empty())
            text += fmt::format("    {}\n", c.note);
    }
    return text;
}

std::string summaryText(const VerifyReport& report) {
    std::string text;
    const auto count = [&](proof::Kind kind, auto&& which) {
        return std::count_if(report.cases.begin(), report.cases.end(), [&](const proof::Case& c) {
            return c.kind == kind && which(c.verdict());
        });
    };
    double total = 0;
    for (const CheckTime& t : report.times) total += t.seconds;
    for (const proof::Kind kind : proof::kinds) {
        const auto all = count(kind, [](proof::Verdict) { return true; });
        const auto passed = count(kind, [](proof::Verdict v) { return v == proof::Verdict::Pass; });
        if (all == 0) continue;
        double seconds = 0;
        for (const CheckTime& t : report.times) seconds += t.kind == kind ? t.seconds : 0;
        text += fmt::format("{:<12} {:>4} cases, {:>4} pass, {:>9} ({:2.0f} % of the time){}\n",
                            proof::nameOf(kind), all, passed, formatDuration(seconds),
                            total > 0 ? 100 * seconds / total : 0,
                            passed == all ? "" : fmt::format(", {} DO NOT", all - passed));
    }
    return text + fmt::format("{} {}\n", report.complete ? "in" : "interrupted after",
                              formatDuration(total));
}

}  // namespace woodcock::tool
