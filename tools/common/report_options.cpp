// SPDX-License-Identifier: Apache-2.0
#include "tools/common/report_options.h"

#include <spdlog/spdlog.h>

#include <thread>

#include "tools/common/about.h"
#include "tools/common/log.h"
#include "tools/common/option_kinds.h"

namespace woodcock::tool {

void ReportOptions::addTo(CLI::App& command, const std::string& jsonHelp) {
    const std::vector<std::string> styles{"auto", "bar", "json", "alfred", "openjd", "none"};
    const std::vector<std::string> levels{"trace", "debug", "info", "warning", "error", "off"};
    const std::vector<CLI::Option*> options{
        addChoice(command, "--progress", progress, styles,
                  "Show how far the work is, on stderr. auto shows a bar on a terminal, and "
                  "nothing elsewhere; alfred and openjd print lines for farms on stdout:")
            ->type_name("STYLE"),
        command.add_flag("--json", json, jsonHelp),
        addParsed(
            command, "--log-level", logLevel,
            [levels](const std::string& word) {
                const std::string name = word == "warn" ? "warning" : word;
                return levels[indexOfWord(name, levels)];
            },
            "Print messages of this level and of those after it: " + joinNames(levels))
            ->type_name("LEVEL"),
        command.add_flag("-q,--quiet", quiet, "Print warnings and errors only")};
    for (CLI::Option* option : options) option->group("Reports");
}

ProgressStyle ReportOptions::start() const {
    const auto exclude = [this](bool other, const char* name) {
        if (quiet && other)
            throw usageError("--quiet and {} contradict each other; give one of them", name);
    };
    exclude(logLevel.has_value(), "--log-level");
    exclude(progress != "auto" && progress != "none", "--progress");
    if (json && (progress == "alfred" || progress == "openjd"))
        throw usageError("--json and --progress {} both print on stdout; give one of them",
                         progress);
    const ProgressStyle style = quiet ? ProgressStyle::None : progressStyle(progress);
    setUpLog(style == ProgressStyle::Json     ? LogStyle::Json
             : style == ProgressStyle::OpenJd ? LogStyle::OpenJd
                                              : LogStyle::Text,
             quiet ? "warning" : logLevel.value_or("info"));
    spdlog::debug("{}, {} threads at most", programVersion(), std::thread::hardware_concurrency());
    return style;
}

}  // namespace woodcock::tool
