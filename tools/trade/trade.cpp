// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <array>
#include <memory>
#include <thread>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/common/progress.h"
#include "tools/common/report_options.h"
#include "tools/common/scene_input.h"
#include "tools/trade/parts.h"
#include "tools/trade/pictures.h"
#include "tools/trade/report.h"
#include "tools/trade/report_answers.h"
#include "tools/trade/report_html.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/scene/scene_file.h"

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

std::optional<trade::TradeResult> measure(const TradeOptions& o,
                                          const scene::SceneDescription& complete,
                                          const std::vector<trade::Candidate>& given,
                                          ProgressStyle style) {
    const trade::ParseScene parse = [&](const std::vector<std::string>& more) {
        SceneInput input = o.input;
        input.overrides.insert(input.overrides.end(), more.begin(), more.end());
        return parseInput(input);
    };
    ProgressBar progress(style, "trade");
    trade::TradeSettings settings;
    settings.budget = o.budget.value_or(defaultBudget);
    settings.threads = o.threads.value_or(0);
    settings.seed = o.seed.value_or(0);
    settings.crops = !o.report.empty();
    settings.onProgress = [&](double fraction, const std::string&) {
        progress.update(fraction);
        return !interrupted();
    };
    return trade::runTrade(complete, parse, given, settings);
}

const std::vector<std::string> reportFiles{"trade.json", "trade.csv", "trade.html"};

/// What was asked, and what was found.
TradeReport reportOf(const TradeOptions& o, const std::string& commandLine,
                     const scene::SceneDescription& scene, trade::TradeResult result) {
    TradeReport report{commandLine, joinedFiles(o.input.files), scene::sceneDigest(scene),
                       RenderCommand(o.input, scene.output.files.empty())};
    report.threads = o.threads.value_or(0) > 0
                         ? *o.threads
                         : static_cast<int>(std::thread::hardware_concurrency());
    report.budget = o.budget.value_or(defaultBudget);
    report.result = std::move(result);
    if (!o.report.empty()) report.pictures = tradePictures(report.result, scene);
    return report;
}

void weighCandidates(const TradeOptions& o, const std::string& commandLine, ProgressStyle style) {
    checkInput(o.input);
    const std::vector<trade::Candidate> given = o.candidates.empty()
                                                    ? std::vector<trade::Candidate>()
                                                    : trade::readCandidates(o.candidates);
    prepareReport(o.report, reportFiles);
    catchInterrupts();
    scene::SceneDescription complete = parseInput(o.input);
    std::vector<std::filesystem::path> read = filesRead(o.input, complete);
    read.push_back(o.candidates);
    for (const std::string& name : reportFiles)
        if (!o.report.empty()) refuseOverwriting(std::array{o.report / name}, read);
    loadAndComplete(complete);

    std::optional<trade::TradeResult> result = measure(o, complete, given, style);
    if (!result) endWith(exitInterrupted);
    const TradeReport report = reportOf(o, commandLine, complete, std::move(*result));
    const nlohmann::ordered_json json = tradeJson(report, false);
    if (o.reports.json)
        printJson(json, 1);
    else if (o.reports.printsText())
        printText(tradeText(report));
    if (o.report.empty()) return;
    writeReport(o.report, {{reportFiles[0], jsonText(json, 1) + "\n"},
                           {reportFiles[1], tradeCsv(report)},
                           {reportFiles[2], tradePage(tradeJson(report, true),
                                                      answersJson(report.result, report.budget))}});
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
    CLI::App* command = app.add_subcommand("trade",
                                           "Measure how fast and how accurate each render setting "
                                           "is on your scene, and recommend one");
    const auto o = std::make_shared<TradeOptions>();
    command->add_option("INPUT", o->input.files, "A scene (.toml), or one or more volumes (.vdb)")
        ->type_name("FILE");
    addOverlay(*command, o->input.overlay);
    command->add_flag(
        "--needs", o->needs,
        "Instead: measure what it would cost to render with features that the scene does not use");
    command->add_flag("--scaling", o->scaling,
                      "Instead: measure how the cost grows with voxels, optical depth, albedo, "
                      "overlapping volumes and threads. Takes no input");
    addParsed(*command, "--budget", o->budget, parseDuration,
              "How long it may take (2m; with --needs 1m; with --scaling 10m)")
        ->type_name("TIME");
    command
        ->add_option("--candidates", o->candidates,
                     "Compare these settings instead of those that come with the program. A TOML "
                     "file with a table [[candidate]] for each: name = \"...\", quality = \"...\", "
                     "set = [\"KEY=VALUE\"]")
        ->type_name("FILE");
    command
        ->add_option(
            "--report", o->report,
            "Write DIR/trade.json, DIR/trade.csv and DIR/trade.html, a page that you can open "
            "anywhere. With --needs and --scaling the files are called needs and scaling")
        ->type_name("DIR");
    addList(*command, "--set", o->input.overrides,
            "Set a value of the scene, such as volume[0].scale=2")
        ->type_name("KEY=VALUE");
    addParsed(*command, "--res", o->input.size, parseImageSize,
              "Image size; a width alone keeps the scene's shape")
        ->type_name("WIDTHxHEIGHT");
    addCount(*command, "--threads", o->threads, 0, 4096,
             "How many processor threads to use. 0 takes all cores");
    addCount(*command, "--seed", o->seed, 0, INT64_MAX / 2,
             "Seed of the random numbers. Another seed gives other noise (0)");
    command->footer(examplesText({"woodcock trade scene.toml --budget 2m --report trade",
                                  "woodcock trade smoke.vdb --needs"}));
    o->reports.addTo(*command, "Print one JSON document on stdout instead of the tables");
    command->callback([o, commandLine] { run(*o, commandLine); });
    return *command;
}

}  // namespace

extern const Command tradeCommand{&addTo};

}  // namespace woodcock::tool
