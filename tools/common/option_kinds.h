// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/parse.h"

namespace woodcock::tool {

// Kinds of options that the commands share.

/// An option whose word `parse` turns into `value`; mistakes name the option.
template <class T, class Parse>
CLI::Option* addParsed(CLI::App& command, const std::string& name, T& value, Parse parse,
                       const std::string& help) {
    return command.add_option_function<std::string>(
        name,
        [name, &value, parse](const std::string& text) {
            try {
                value = parse(text);
            } catch (const Error& error) {
                throw usageError("{}: {}", name, error.what());
            }
        },
        help);
}

/// An option with a whole number from `lowest` to `highest`.
template <class T>
CLI::Option* addCount(CLI::App& command, const std::string& name, std::optional<T>& value,
                      std::uint64_t lowest, std::uint64_t highest, const std::string& help) {
    const auto parse = [=](const std::string& text) {
        return static_cast<T>(parseCount(text, lowest, highest));
    };
    return addParsed(command, name, value, parse, help)->type_name("COUNT");
}

/// The end of a command's help: lines that work as they are.
inline std::string examplesText(const std::vector<std::string>& examples) {
    std::string text = "Examples:";
    for (const std::string& line : examples) text += "\n  " + line;
    return text;
}

/// The place of `word` among the words `known`.
inline std::size_t indexOfWord(const std::string& word, const std::vector<std::string>& known) {
    const auto found = std::find(known.begin(), known.end(), word);
    if (found == known.end())
        throw usageError("unknown word '{}'{}", word, suggestName(word, "known", known));
    return static_cast<std::size_t>(found - known.begin());
}

/// An option with one of the words `known`.
template <class T>
CLI::Option* addChoice(CLI::App& command, const std::string& name, T& value,
                       const std::vector<std::string>& known, const std::string& help) {
    const auto parse = [known](const std::string& word) { return known[indexOfWord(word, known)]; };
    return addParsed(command, name, value, parse, fmt::format("{} {}", help, joinNames(known)));
}

/// An option with one of the words `known`, which name the values of an enum in their order.
template <class Enum, std::size_t n>
CLI::Option* addEnum(CLI::App& command, const std::string& name, std::optional<Enum>& value,
                     const std::array<std::string, n>& known, const std::string& help) {
    const std::vector<std::string> words(known.begin(), known.end());
    const auto parse = [words](const std::string& word) {
        return static_cast<Enum>(indexOfWord(word, words));
    };
    return addParsed(command, name, value, parse, fmt::format("{} {}", help, joinNames(words)));
}

/// An option that may be given again, for one more value each time.
template <class T>
CLI::Option* addList(CLI::App& command, const std::string& name, std::vector<T>& values,
                     const std::string& help) {
    return command.add_option(name, values, help + "; may be repeated")->allow_extra_args(false);
}

}  // namespace woodcock::tool
