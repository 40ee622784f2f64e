// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "tools/common/json_text.h"
#include "tools/verify/report.h"
#include "woodcock/base/version.h"

namespace woodcock::tool {

using namespace proof;
using Json = nlohmann::ordered_json;

namespace {

Json build() {
#ifdef __clang__
    const std::string compiler = "Clang " __clang_version__;
#else
    const std::string compiler = "GCC " __VERSION__;
#endif
#ifdef NDEBUG
    const bool assertions = false;
#else
    const bool assertions = true;
#endif
    return {{"compiler", compiler}, {"assertions", assertions}};
}

Json caseJson(const proof::Case& c) {
    Json j{{"kind", proof::nameOf(c.kind)},
           {"case", c.name},
           {"expected", c.expected},
           {"allowance", c.allowance},
           {"measured", c.measured},
           {"standard_error", c.standardError},
           {"largest_error", c.largestError},
           {"z", c.z()},
           {"verdict", proof::nameOf(c.verdict())}};
    if (!c.note.empty()) j["note"] = c.note;
    if (!c.curve.empty()) j["curve"] = c.curve, j["x_name"] = c.xName, j["x"] = c.x;
    return j;
}

}  // namespace

std::string reportJson(const VerifyReport& report) {
    Json cases = Json::array(), checks = Json::array(), volumes = Json::array();
    for (const proof::Case& c : report.cases) cases.push_back(caseJson(c));
    double seconds = 0;
    for (const CheckTime& t : report.times) {
        checks.push_back(
            {{"kind", proof::nameOf(t.kind)}, {"check", t.name}, {"seconds", t.seconds}});
        seconds += t.seconds;
    }
    for (const auto& file : report.options.volumes) volumes.push_back(file.string());
    const Json json{{"version", version()},
                    {"build", build()},
                    {"threads", std::thread::hardware_concurrency()},
                    {"date", report.date},
                    {"full", report.options.full},
                    {"quality", report.options.adaptive ? "final" : "reference"},
                    {"seed", report.options.seed},
                    {"only", report.only},
                    {"volumes", volumes},
                    {"complete", report.complete},
                    {"largest_z", proof::largestZ},
                    {"seconds", seconds},
                    {"checks", checks},
                    {"cases", cases}};
    // File names need not be UTF-8.
    return jsonText(json) + "\n";
}

}  // namespace woodcock::tool
