// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <new>
#include <vector>

#include "tools/common/about.h"
#include "tools/commands.h"
#include "tools/common/log.h"
#include "tools/common/print.h"
#include "tools/common/stats.h"
#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/nearest_name.h"

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
        if (!option->get_lnames().empty() && !option->get_group().empty())  // no hidden ones
            names.push_back("--" + option->get_lnames().front());
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

/// What stands for options that other programs have and this one has not.
std::string answerFor(std::string_view option) {
    constexpr std::pair<std::string_view, std::string_view> answers[]{
        {"--width", "the image's size is --res WIDTHxHEIGHT"},
        {"--height", "the image's size is --res WIDTHxHEIGHT"},
        {"--size", "the image's size is --res WIDTHxHEIGHT"},
        {"--resolution", "the image's size is --res WIDTHxHEIGHT"},
        {"--preview", "a quick picture is --quality draft --res 320 --spp 16"},
        {"--draft", "it is --quality draft"},
        {"--verbose", "--log-level debug says more"},
        {"--debug", "it is --log-level debug"},
        {"-v", "--log-level debug says more, and -V tells the version"},
        {"--silent", "it is --quiet"},
        {"--gpu", "renders use the processor alone"},
        {"--device", "renders use the processor alone"},
        {"--frames", "one call draws one frame; a shell's loop or a farm calls it for each"},
        {"--resume", "a render cannot be resumed"},
        {"--overwrite", "outputs are written over"},
        {"--force", "outputs are written over"},
        {"--out", "it is -o or --output"},
        {"--jobs", "it is --threads"},
        {"-j", "it is --threads"}};
    for (const auto& [name, answer] : answers)
        if (name == option) return fmt::format("; {}", answer);
    return "";
}

/// "; did you mean --noise?", or where to look.
std::string suggestOption(const std::string& word, const CLI::App& command,
                          const std::string& name) {
    const std::string option = word.substr(0, word.find('='));
    if (const std::string answer = answerFor(option); !answer.empty()) return answer;
    const std::string nearest = nearestName(option, namesOf(command.get_options()));
    return nearest.empty() ? fmt::format("; {} --help lists those that there are", name)
                           : fmt::format("; did you mean '{}'?", nearest);
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
        if (words.front().starts_with("-"))
            return usageError("unknown option '{}'{}", words.front(),
                              suggestOption(words.front(), app, "woodcock"));
        return usageError("unknown command '{}'{}", words.front(),
                          suggestName(words.front(), "known", known));
    }
    const CLI::App& command = *commands.front();
    const std::string name = "woodcock " + command.get_name();
    const std::vector<std::string> left = command.remaining();
    for (const std::string& word : left)
        if (word.starts_with("-"))
            return usageError("{}: unknown option {}{}", name, word,
                              suggestOption(word, command, name));
    if (!left.empty())
        return usageError("{}: '{}' is more than the command takes; {} --help tells what it does",
                          name, left.front(), name);
    return usageError("{}: {}", name, describeMistake(error, command));
}

/// `woodcock version` and `woodcock help`, as many expect them beside --version and --help.
void addHelpCommands(CLI::App& app, const std::string& programHelp) {
    app.add_subcommand("version", "Print the versions of the program and of its libraries")
        ->callback([] { tool::print("{}\n", tool::aboutProgram()); });
    CLI::App* const help = app.add_subcommand("help", "Print the help of the program or a command");
    const auto name = std::make_shared<std::string>();
    help->add_option("COMMAND", *name, "Whose help to print; the program's if not given")
        ->type_name("");
    help->callback([&app, &programHelp, name] {
        std::vector<std::string> known;
        for (const CLI::App* command : app.get_subcommands(nullptr)) {
            known.push_back(command->get_name());
            if (known.back() == *name) return tool::print("{}", command->help("woodcock"));
        }
        if (!name->empty())
            throw usageError("woodcock help: unknown command '{}'{}", *name,
                             suggestName(*name, "known", known));
        tool::print("{}", programHelp);
    });
}

int run(int argc, char** argv) {
    CLI::App app("Renders OpenVDB volumes.", "woodcock");
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::simple);
    app.footer(
        "Exit codes: 0 done, 1 failed while working, 2 wrong usage, 3 bad input, 130 interrupted.\n"
        "woodcock COMMAND --help tells more, with examples.");
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
    std::string help;
    addHelpCommands(app, help);
    app.set_version_flag("-V,--version", tool::aboutProgram,
                         "Print the versions of the program and its libraries");
    for (CLI::App* command : app.get_subcommands(nullptr))
        command->set_version_flag("-V,--version", tool::aboutProgram)->group("");
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
                  formatGiB(static_cast<double>(tool::peakMemoryBytes())));
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
