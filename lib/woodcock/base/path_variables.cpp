// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/path_variables.h"

#include <cctype>
#include <cstdlib>

#include "woodcock/base/error.h"

namespace woodcock {
namespace {

std::string variable(const std::string& name) {
    if (const char* value = std::getenv(name.c_str())) return value;
    throw inputError("the environment variable {} is not set; set it, or give a path without it",
                     name);
}

/// $F, $F4: a frame's number, as withFrame() fills it in, and no variable.
bool isFrame(std::string_view name) {
    return name.starts_with('F') && name.size() <= 3 &&
           name.find_first_not_of("0123456789", 1) == name.npos;
}

bool isNameLetter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

}  // namespace

std::filesystem::path expandPath(std::string_view text) {
    std::string expanded;
    size_t i = 0;
    if (text == "~" || text.starts_with("~/")) expanded = variable("HOME"), i = 1;
    while (i < text.size()) {
        if (text[i] != '$') {
            expanded += text[i++];
            continue;
        }
        ++i;
        if (i < text.size() && text[i] == '$') {
            expanded += text[i++];
            continue;
        }
        const bool braces = i < text.size() && text[i] == '{';
        const size_t begin = braces ? i + 1 : i;
        size_t end = begin;
        while (end < text.size() && isNameLetter(text[end])) ++end;
        const bool closed = !braces || (end < text.size() && text[end] == '}');
        if (end == begin || !closed)
            throw inputError("'$' must be followed by a variable's name (write $$ for a dollar)");
        const std::string_view name = text.substr(begin, end - begin);
        const size_t next = braces ? end + 1 : end;
        expanded += isFrame(name) ? std::string(text.substr(begin - (braces ? 2 : 1),
                                                            next - begin + (braces ? 2 : 1)))
                                  : variable(std::string(name));
        i = next;
    }
    return expanded;
}

std::string escapePath(const std::filesystem::path& path) {
    const std::string text = path.string();
    std::string escaped = text.starts_with("~") ? "./" : "";
    for (const char c : text) escaped += c == '$' ? "$$" : std::string(1, c);
    return escaped;
}

}  // namespace woodcock
