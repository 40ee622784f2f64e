// SPDX-License-Identifier: Apache-2.0
#include "tools/common/usage_mistakes.h"

#include <fmt/core.h>

#include <string>
#include <vector>

#include "woodcock/base/nearest_name.h"

namespace woodcock::tool {

namespace {

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
        {"--frames", "this command works on one frame; a shell's loop calls it for each"},
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

/// The program, or a command that consists of others, is called without one of these, or with one
/// that there is not. `name`: by which it is called.
Error explainWithoutCommand(const CLI::App& app, const std::string& name) {
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands(nullptr))
        known.push_back(command->get_name());
    const std::string where = name == "woodcock" ? "" : name + ": ";
    const std::vector<std::string> words = app.remaining();
    if (words.empty())
        return usageError("{}no command is given; there are: {}", where, joinNames(known));
    const std::string& word = words.front();
    if (word.starts_with("-"))
        return usageError("{}unknown option '{}'{}", where, word, suggestOption(word, app, name));
    return usageError("{}unknown command '{}'{}", where, word, suggestName(word, "known", known));
}

/// `before`: the words before the command's name.
Error explainIn(const std::string& before, const CLI::App& command, const CLI::ParseError& error) {
    const std::string name = before + " " + command.get_name();
    if (const auto inner = command.get_subcommands(); !inner.empty())
        return explainIn(name, *inner.front(), error);
    if (!command.get_subcommands(nullptr).empty()) return explainWithoutCommand(command, name);
    const std::vector<std::string> left = command.remaining();
    for (const std::string& word : left)
        if (word.starts_with("-"))
            return usageError("{}: unknown option {}{}", name, word,
                              suggestOption(word, command, name));
    if (!left.empty())
        return usageError("{}: '{}' is one word too many; {} --help tells what the command takes",
                          name, left.front(), name);
    return usageError("{}: {}", name, describeMistake(error, command));
}

}  // namespace

Error explain(const CLI::ParseError& error, const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    return commands.empty() ? explainWithoutCommand(app, "woodcock")
                            : explainIn("woodcock", *commands.front(), error);
}

}  // namespace woodcock::tool
