// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "commands.h"
#include "interrupt.h"
#include "tests/proof/proof.h"
#include "verify_report.h"
#include "woodcock/base/error.h"
#include "woodcock/image/whole_file.h"

namespace woodcock::tool {

namespace {

using namespace proof;

constexpr int exitFailed = 1, exitInterrupted = 130;

struct VerifyOptions {
    bool quick = false, full = false;
    std::uint64_t seed = 1;
    std::filesystem::path report;
    std::vector<std::filesystem::path> volumes;
};

void write(const std::filesystem::path& file, const std::string& text) {
    writeWholeFile(file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

void runVerify(const VerifyOptions& o) {
    if (o.quick && o.full)
        throw usageError("--quick and --full contradict each other: give one of them");
    for (const auto& file : o.volumes)
        if (!exists(file)) throw inputError("{}: there is no such file", file.string());
    if (!o.report.empty()) std::filesystem::create_directories(o.report);
    catchInterrupts();
    const Options options{.full = o.full, .seed = o.seed, .volumes = o.volumes};
    std::vector<Case> all;
    std::size_t done = 0;
    for (const Check& check : checks()) {
        if (interrupted()) break;
        if (isatty(STDERR_FILENO))
            fmt::print(stderr, "\r[{}/{}] {}\x1b[K", done, checks().size(), check.name);
        const std::vector<Case> cases = run(check, options);
        if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\x1b[K");
        fmt::print("{}", casesText(check.name, cases));
        std::fflush(stdout);
        all.insert(all.end(), cases.begin(), cases.end());
        ++done;
    }
    fmt::print("{}", summaryText(all));
    if (!o.report.empty()) {
        const VerifyReport report{all, options, done == checks().size()};
        write(o.report / "verify.json", reportJson(report));
        write(o.report / "verify.html", reportHtml(report));
        fmt::print("wrote {} and {}\n", (o.report / "verify.json").string(),
                   (o.report / "verify.html").string());
    }
    if (done < checks().size()) throw CLI::RuntimeError(exitInterrupted);
    if (std::any_of(all.begin(), all.end(),
                    [](const Case& c) { return c.verdict() != Verdict::Pass; }))
        throw CLI::RuntimeError(exitFailed);
}

}  // namespace

CLI::App& addVerifyCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "verify",
        "Holds this build on this machine against closed forms, published tables and properties "
        "that any volume has");
    auto options = std::make_shared<VerifyOptions>();
    command->add_flag("--quick", options->quick, "two digits, in about a minute (the default)");
    command->add_flag("--full", options->full, "three digits and more, in about half an hour");
    command
        ->add_option("--report", options->report,
                     "writes DIR/verify.json and DIR/verify.html, a page that needs nothing else")
        ->type_name("DIR");
    command
        ->add_option("--seed", options->seed,
                     "draws other random numbers; of 1000 cases, chance fails one in 16 runs")
        ->type_name("N");
    command
        ->add_option("FILE", options->volumes,
                     "VDB files of your own, to hold the properties of any volume against")
        ->type_name("FILE");
    command->callback([options] { runVerify(*options); });
    return *command;
}

}  // namespace woodcock::tool
