// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <array>
#include <memory>
#include <thread>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/interrupt.h"
#include "tools/common/option_kinds.h"
#include "tools/common/print.h"
#include "tools/common/progress.h"
#include "tools/common/report_options.h"
#include "tools/common/scene_input.h"
#include "tools/trade/parts.h"
#include "tools/trade/pictures.h"
#include "tools/trade/report.h"
#include "tools/trade/report_html.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/scene/write.h"

namespace woodcock::tool {

namespace {

constexpr double defaultBudget = 120;

struct TradeOptions {
    SceneInput input;
    std::optional<double> budget;
    std::optional<int> threads;
    std::optional<std::uint64_t> seed;
    std::filesystem::path report, candidates;
    bool needs = false, scaling = false;
    ReportOptions reports;
};

std::string joinedFiles(const std::vector<std::filesystem::path>& files) {
    std::vector<std::string> names;
    for (const auto& file : files) names.push_back(file.string());
    return fmt::format("{}", fmt::join(names, " "));
}

std::optional<TradeResult> measure(const TradeOptions& o, const SceneDescription& complete,
                                   const std::vector<Candidate>& given, ProgressStyle style) {
    const ParseScene parse = [&](const std::vector<std::string>& more) {
        SceneInput input = o.input;
        input.overrides.insert(input.overrides.end(), more.begin(), more.end());
        return parseInput(input);
    };
    WorkProgress progress(style, "trade");
    TradeSettings settings;
    settings.budget = o.budget.value_or(defaultBudget);
    settings.threads = o.threads.value_or(0);
    settings.seed = o.seed.value_or(0);
    settings.crops = !o.report.empty();
    settings.onProgress = [&](double fraction, const std::string&) {
        progress.update(fraction);
        return !interrupted();
    };
    return runTrade(complete, parse, given, settings);
}

void weighCandidates(const TradeOptions& o, const std::string& commandLine, ProgressStyle style) {
    checkInput(o.input);
    const std::vector<Candidate> given =
        o.candidates.empty() ? std::vector<Candidate>() : readCandidates(o.candidates);
    prepareReport(o.report, {"trade.json", "trade.csv", "trade.html"});
    catchInterrupts();
    SceneDescription complete = parseInput(o.input);
    std::vector<std::filesystem::path> read = filesRead(o.input, complete);
    read.push_back(o.candidates);
    for (const char* name : {"trade.json", "trade.csv", "trade.html"})
        if (!o.report.empty()) refuseOverwriting(std::array{o.report / name}, read);
    loadAndComplete(complete);

    std::optional<TradeResult> result = measure(o, complete, given, style);
    if (!result) endWith(exitInterrupted);
    TradeReport report{commandLine, joinedFiles(o.input.files), sceneDigest(complete),
                       RenderCommand(o.input, complete.output.files.empty())};
    report.threads = o.threads.value_or(0) > 0
                         ? *o.threads
                         : static_cast<int>(std::thread::hardware_concurrency());
    report.budget = o.budget.value_or(defaultBudget);
    report.result = std::move(*result);
    if (!o.report.empty()) report.pictures = tradePictures(report.result, complete);
    const std::string text =
        tradeJson(report, false).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) +
        "\n";
    if (o.reports.json)
        printData(text);
    else if (o.reports.printsText())
        printText(tradeText(report));
    if (o.report.empty()) return;
    writeReport(o.report / "trade.json", text);
    writeReport(o.report / "trade.csv", tradeCsv(report));
    writeReport(o.report / "trade.html", tradePage(tradeJson(report, true)));
}

/// Throws Error{Usage} where an option speaks of what is not asked for.
void check(const TradeOptions& o) {
    if (o.needs && o.scaling) throw usageError("--needs contradicts --scaling; take one at a time");
    const char* const mode = o.needs ? "--needs" : "--scaling";
    if (o.needs || o.scaling) {
        if (!o.candidates.empty())
            throw usageError("{} contradicts --candidates: it compares none", mode);
        if (o.threads || o.seed)
            throw usageError("{} contradicts {}", mode, o.threads ? "--threads" : "--seed");
    }
    if (!o.scaling && o.input.files.empty())
        throw usageError("there is no input; name a scene (.toml) or volumes (.vdb)");
    if (o.scaling && !o.input.files.empty())
        throw usageError("--scaling makes its own scenes, but '{}' is given",
                         o.input.files.front().string());
}

void run(const TradeOptions& o, const std::string& commandLine) {
    const ProgressStyle style = o.reports.start();
    check(o);
    if (o.needs)
        runNeeds(o.input, o.budget.value_or(60), o.report, o.reports);
    else if (o.scaling)
        runScaling(o.budget.value_or(600), o.report, o.reports);
    else
        weighCandidates(o, commandLine, style);
}

CLI::App& addTo(CLI::App& app, const std::string& commandLine) {
    CLI::App* command = app.add_subcommand(
        "trade", "Measure what each choice costs and brings on a scene, and tell which to take");
    const auto o = std::make_shared<TradeOptions>();
    command->add_option("INPUT", o->input.files, "A scene (.toml), or one or more volumes (.vdb)")
        ->type_name("FILE");
    addOverlay(*command, o->input.overlay);
    command->add_flag("--needs", o->needs,
                      "Measure what features that the scene does not need would cost it, instead");
    command->add_flag("--scaling", o->scaling,
                      "Measure how cost grows with voxels, optical depth, albedo, overlapping "
                      "volumes and threads, instead; takes no input");
    addParsed(*command, "--budget", o->budget, parseDuration,
              "The time it may take (2m; --needs: 1m; --scaling: 10m)")
        ->type_name("TIME");
    command
        ->add_option("--candidates", o->candidates,
                     "What to compare, instead of what the program comes with: a TOML file of "
                     "[[candidate]] name = \"...\", quality = \"...\", set = [\"KEY=VALUE\"]")
        ->type_name("FILE");
    command
        ->add_option("--report", o->report,
                     "Write DIR/trade.json, DIR/trade.csv and DIR/trade.html, a page that needs "
                     "nothing else (--needs, --scaling: under their names)")
        ->type_name("DIR");
    addList(*command, "--set", o->input.overrides,
            "Set a value of the scene, such as volume[0].scale=2")
        ->type_name("KEY=VALUE");
    addParsed(*command, "--res", o->input.size, parseImageSize,
              "Image size; a width alone keeps the scene's shape")
        ->type_name("WIDTHxHEIGHT");
    addCount(*command, "--threads", o->threads, 0, 4096,
             "How many processor threads to use (0: all cores)");
    addCount(*command, "--seed", o->seed, 0, INT64_MAX / 2,
             "Start of the random numbers: another seed gives other noise (0)");
    command->footer(examplesText({"woodcock trade scene.toml --budget 2m --report trade",
                                  "woodcock trade smoke.vdb --needs"}));
    o->reports.addTo(*command, "Print one JSON document on stdout instead of the tables");
    command->callback([o, commandLine] { run(*o, commandLine); });
    return *command;
}

}  // namespace

extern const Command tradeCommand{&addTo};

}  // namespace woodcock::tool
