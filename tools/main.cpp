// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <new>
#include <vector>

#include "commands.h"
#include "log.h"
#include "print.h"
#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/version.h"

namespace {

using namespace woodcock;

int exitCode(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Failure:
            return 1;
        case ErrorKind::Usage:
            return 2;
        case ErrorKind::Input:
            return 3;
    }
    return 1;
}

std::string commandLine(int argc, char** argv) {
    std::string line;
    for (int i = 0; i < argc; ++i) {
        const std::string word = argv[i];
        const bool plain = word.find_first_of(" \t\n'\"\\$&|;<>()*?[]{}`") == std::string::npos;
        line += (i ? " " : "") + (plain ? word : '"' + word + '"');
    }
    return line;
}

std::vector<std::string> namesOf(const std::vector<const CLI::Option*>& options) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options)
        if (!option->get_lnames().empty()) names.push_back("--" + option->get_lnames().front());
    return names;
}

/// The mistake in one option, or in what is missing.
std::string describeMistake(const CLI::ParseError& error, const CLI::App& command) {
    const std::string text = error.what();
    std::string name = text.substr(0, text.find_first_of(": "));
    const CLI::Option* option = command.get_option_no_throw(name);
    if (!option && (option = command.get_option_no_throw("--" + name))) name = "--" + name;
    if (dynamic_cast<const CLI::RequiredError*>(&error) && option)
        return fmt::format("no {} is given: {}", name, option->get_description());
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) && option) {
        if (option->get_items_expected_max() == 0) return name + " takes no value";
        if (option->results().size() > 1) return name + " is given twice; give it once";
        return fmt::format("{} has no value; give one, as in {} {}", name, name,
                           option->get_type_name());
    }
    return text;
}

/// The mistake in words that help.
Error explain(const CLI::ParseError& error, const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    if (commands.empty()) {
        std::vector<std::string> known;
        for (const CLI::App* command : app.get_subcommands(nullptr))
            known.push_back(command->get_name());
        const std::vector<std::string> words = app.remaining();
        if (words.empty())
            return usageError("no command is given; there are: {}", joinNames(known));
        return usageError(
            "unknown {} '{}'{}", words.front().starts_with("-") ? "option" : "command",
            words.front(),
            suggestName(words.front(), "known",
                        words.front().starts_with("-") ? namesOf(app.get_options()) : known));
    }
    const CLI::App& command = *commands.front();
    for (const std::string& word : command.remaining())
        if (word.starts_with("-"))
            return usageError("woodcock {}: unknown option {}{}", command.get_name(), word,
                              suggestName(word, "known", namesOf(command.get_options())));
    return usageError("woodcock {}: {}", command.get_name(), describeMistake(error, command));
}

int run(int argc, char** argv) {
    CLI::App app("Renders OpenVDB volumes.", "woodcock");
    app.set_version_flag("--version", fmt::format("woodcock {}", version()));
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::simple);
    app.footer(
        "Exit codes: 0 done, 1 failed while working, 2 wrong usage, 3 bad input, 130 interrupted.");
    tool::addRenderCommand(app, commandLine(argc, argv));
    tool::addBakeCommand(app);
    tool::addConvertCommand(app);
    tool::addInfoCommand(app);
    tool::addCompareCommand(app, commandLine(argc, argv));
    tool::addTradeCommand(app, commandLine(argc, argv));
    tool::addVerifyCommand(app);
    tool::addCyclesCommand(app, commandLine(argc, argv));
    for (CLI::App* command : app.get_subcommands(nullptr))
        for (CLI::Option* option : command->get_options()) option->disable_flag_override();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // Help, the version and codes that a command asks for are no mistakes.
        if (error.get_exit_code() == 0 || dynamic_cast<const CLI::RuntimeError*>(&error))
            return app.exit(error);
        throw explain(error, app);
    }
    return 0;
}

/// The exit code of `act`; what goes wrong in it is said.
template <class Act>
int report(Act act) {
    try {
        return act();
    } catch (const Error& error) {
        spdlog::error("{}", error.what());
        return exitCode(error.kind());
    } catch (const std::bad_alloc&) {
        spdlog::error("out of memory");
    } catch (const std::exception& error) {
        spdlog::error(
            "{}: the program did not expect this; please report it with the command and its files",
            error.what());
    }
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    tool::holdStandardStreams();
    // A reader that ends and a limit of file sizes are errors of writing, not the program's end.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    const int code = report([&] {
        tool::setUpLog(tool::LogStyle::Text, "info");
        return run(argc, argv);
    });
    const int printed = report([] {
        tool::finishStdout();
        return 0;
    });
    return code ? code : printed;
}
