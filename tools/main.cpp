// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>
#include <new>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/help_command.h"
#include "tools/common/log.h"
#include "tools/common/print.h"
#include "tools/common/render_command.h"
#include "tools/common/stats.h"
#include "tools/common/usage_mistakes.h"
#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"

namespace {

using namespace woodcock;
using namespace woodcock::tool;

std::string commandLine(int argc, char** argv) {
    std::string line;
    for (int i = 0; i < argc; ++i) line += (i ? " " : "") + shellWord(argv[i]);
    return line;
}

void addCommands(CLI::App& app, const std::string& line) {
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::simple);
    app.footer(fmt::format(
        "Exit codes: {} done, {} failed while working, {} wrong usage, {} bad input, {} "
        "interrupted.\n"
        "woodcock COMMAND --help tells more, with examples.",
        int{exitDone}, int{exitFailed}, int{exitWrongUsage}, int{exitBadInput},
        int{exitInterrupted}));
    for (const Command& command : allCommands())
        for (CLI::Option* option : command.add(app, line).get_options())
            option->disable_flag_override();
}

int run(int argc, char** argv) {
    CLI::App app("Renders OpenVDB volumes.", "woodcock");
    addCommands(app, commandLine(argc, argv));
    std::string help;
    addHelpCommands(app, help);
    help = app.help();  // before the parse: after it, CLI11 gives the help of the command
    const auto start = std::chrono::steady_clock::now();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // Help, the version and codes that a command asks for are no mistakes.
        if (error.get_exit_code() == 0 || dynamic_cast<const CLI::RuntimeError*>(&error))
            return app.exit(error);
        throw explain(error, app);
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    spdlog::debug("done in {:.2f} s, with at most {} of memory", time.count(),
                  formatGiB(static_cast<double>(peakMemoryBytes())));
    return exitDone;
}

/// The exit code of `act`; what goes wrong in it is said.
template <class Act>
int report(Act act) {
    try {
        return act();
    } catch (const Error& error) {
        spdlog::error("{}", error.what());
        return exitCodeOf(error.kind());
    } catch (const std::bad_alloc&) {
        spdlog::error("out of memory");
    } catch (const std::exception& error) {
        spdlog::error(
            "{}: the program did not expect this; please report it with the command and its files",
            error.what());
    }
    return exitFailed;
}

}  // namespace

int main(int argc, char** argv) {
    holdStandardStreams();
    // A reader that ends and a limit of file sizes are errors of writing, not the program's end.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    const int code = report([&] {
        setUpLog(LogStyle::Text, "info");
        return run(argc, argv);
    });
    const int printed = report([] {
        finishStdout();
        return int{exitDone};
    });
    return code != exitDone ? code : printed;
}
