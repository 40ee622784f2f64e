// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/interrupt.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/common/progress.h"
#include "tools/common/report_options.h"
#include "tools/verify/purpose.h"
#include "tools/verify/report.h"
#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/parse.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/proof/proof.h"

namespace woodcock::tool {

namespace {

using namespace proof;

struct VerifyOptions {
    bool quick = false, full = false;
    ReportOptions reports;
    std::string quality = "reference";
    std::uint64_t seed = 1;
    std::string only;
    std::filesystem::path report;
    std::vector<std::filesystem::path> volumes;
};

/// What would waste the time that checks take.
void validate(const VerifyOptions& o) {
    if (o.quick && o.full)
        throw usageError("--quick and --full contradict each other: give one of them");
    for (const auto& file : o.volumes) grid::listGrids(file);
    prepareReport(o.report, {"verify.json", "verify.html"});
}

/// The checks whose kind or name contains `only`.
std::vector<proof::Check> chosenChecks(const std::string& only) {
    std::vector<proof::Check> chosen;
    std::vector<std::string> names;
    for (const proof::Check& check : proof::checks()) {
        names.push_back(fmt::format("{} ({})", check.name, proof::nameOf(check.kind)));
        if (names.back().find(only) != std::string::npos) chosen.push_back(check);
    }
    if (chosen.empty())
        throw usageError("--only: no check's name or kind contains '{}'; there are: {}", only,
                         joinNames(names));
    return chosen;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void runChecks(const std::vector<proof::Check>& list, bool print, ProgressStyle style,
               VerifyReport& report) {
    ProgressBar progress(style, "verify");
    for (const proof::Check& check : list) {
        const std::size_t done = report.times.size();
        report.options.stop = [&] {
            progress.update(static_cast<double>(done) / static_cast<double>(list.size()),
                            check.name);
            return interrupted();
        };
        if (report.options.stop()) break;
        const auto start = std::chrono::steady_clock::now();
        const std::vector<proof::Case> cases = proof::run(check, report.options);
        report.times.push_back({check.kind, check.name, secondsSince(start)});
        spdlog::debug("{}: {} cases in {:.2f} s", check.name, cases.size(), secondsSince(start));
        report.cases.insert(report.cases.end(), cases.begin(), cases.end());
        progress.clear();
        if (print) printText(casesText(check.name, cases));
        std::fflush(stdout);
    }
    progress.clear();
    report.options.stop = {};
    report.complete = !interrupted();
}

void runVerify(const VerifyOptions& o) {
    const ProgressStyle style = o.reports.start();
    const std::vector<proof::Check> list = chosenChecks(o.only);
    catchInterrupts();
    validate(o);
    VerifyReport report;
    report.options = {
        .full = o.full, .adaptive = o.quality == "final", .seed = o.seed, .volumes = o.volumes};
    report.only = o.only;
    report.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    runChecks(list, o.reports.printsText(), style, report);
    if (o.reports.json)
        printData(reportJson(report));
    else if (o.reports.printsText())
        printText(summaryText(report));
    std::fflush(stdout);
    if (!o.report.empty())
        writeReport(o.report,
                    {{"verify.json", reportJson(report)}, {"verify.html", reportHtml(report)}});
    if (!report.complete) endWith(exitInterrupted);
    const auto failed =
        std::count_if(report.cases.begin(), report.cases.end(),
                      [](const proof::Case& c) { return c.verdict() != proof::Verdict::Pass; });
    if (failed == 0) return;
    if (o.reports.quiet) spdlog::error("{} of {} cases fail", failed, report.cases.size());
    endWith(exitFailed);
}

CLI::App& addTo(CLI::App& app, const std::string&) {
    CLI::App* command = app.add_subcommand("verify", verifyPurpose);
    auto options = std::make_shared<VerifyOptions>();
    command->add_flag("--quick", options->quick,
                      "Check to two digits, in four minutes on two cores (the default)");
    command->add_flag(
        "--full", options->full,
        "Check the tables of slabs to three digits, which takes one to two hours on two cores");
    addChoice(*command, "--quality", options->quality, {"reference", "final"},
              "Which quality to check. final samples adaptively. The qualities that are not here "
              "are biased:")
        ->type_name("NAME");
    command
        ->add_option(
            "--only", options->only,
            "Run only the checks whose kind or name contains TEXT, such as 'slab' or 'half-space'")
        ->type_name("TEXT");
    command
        ->add_option("--report", options->report,
                     "Write DIR/verify.json and DIR/verify.html, a page that you can open anywhere")
        ->type_name("DIR");
    options->reports.addTo(*command, "Print one JSON document on stdout instead of the table");
    command
        ->add_option("--seed", options->seed,
                     "Seed of the random numbers (1). Chance alone fails one of 1000 cases in one "
                     "of 16 runs")
        ->type_name("N");
    command
        ->add_option("INPUT", options->volumes,
                     "VDB files of your own. The properties that hold for any volume are tested on "
                     "them, too")
        ->type_name("FILE");
    command->footer(
        examplesText({"woodcock verify", "woodcock verify smoke.vdb --only slab --report proof"}));
    command->callback([options] { runVerify(*options); });
    return *command;
}

}  // namespace

extern const Command verifyCommand{&addTo};

}  // namespace woodcock::tool
