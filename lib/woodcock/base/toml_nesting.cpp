// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/toml_nesting.h"

#include <algorithm>

#include "woodcock/base/error.h"

namespace woodcock {

namespace {

/// The end of the string that begins at `at`, or of the text.
std::size_t endOfString(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const std::string three(3, quote);
    const bool lines = text.substr(at, 3) == three;
    for (std::size_t i = at + (lines ? 3 : 1); i < text.size(); ++i) {
        if (quote == '"' && text[i] == '\\')
            ++i;
        else if (lines && text.substr(i, 3) == three)
            return i + 3;
        else if (!lines && (text[i] == quote || text[i] == '\n'))
            return i + 1;
    }
    return text.size();
}

}  // namespace

void refuseDeepKeys(std::string_view text, const std::string& name) {
    std::size_t dots = 0, line = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            const std::size_t end = endOfString(text, i);
            line += static_cast<std::size_t>(
                std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                           text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            i = end - 1;
        } else if (c == '#') {
            i = std::min(text.find('\n', i), text.size()) - 1;
        } else if (c == '.') {
            if (++dots >= mostKeyParts)
                throw inputError("{}:{}: a key has more than {} parts; no known key has so many",
                                 name, line, mostKeyParts);
        } else if (std::string_view("\n=,{}[]").find(c) != std::string_view::npos) {
            dots = 0;
            line += c == '\n';
        }
    }
}

}  // namespace woodcock
