// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

#include "woodcock/base/printable.h"

namespace woodcock {
namespace {

bool sameLetter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
}

/// Optimal string alignment distance (Damerau 1964): row by row, the last three rows kept.
size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t change = sameLetter(a[i - 1], b[j - 1]) ? 0 : 1;
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + change});
            const bool swapped =
                i > 1 && j > 1 && sameLetter(a[i - 1], b[j - 2]) && sameLetter(a[i - 2], b[j - 1]);
            if (swapped) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
        }
        beforeLast.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

}  // namespace

std::string nearestName(std::string_view word, std::span<const std::string> known) {
    constexpr size_t longestWord = 100;  // longer words are not typing mistakes
    if (word.size() > longestWord) return {};
    std::string nearest;
    size_t fewest = std::max<size_t>(1, word.size() / 3) + 1;
    for (const std::string& name : known) {
        const size_t edits = editDistance(word, name);
        if (edits < fewest) fewest = edits, nearest = name;
    }
    return nearest;
}

std::string joinNames(std::span<const std::string> names) {
    constexpr size_t longestText = 2000;
    std::string text;
    for (size_t i = 0; i < names.size(); ++i) {
        if (text.size() > longestText) return fmt::format("{} and {} more", text, names.size() - i);
        text += (i ? ", " : "") + shown(names[i]);
    }
    return text.empty() ? "none" : text;
}

std::string suggestName(std::string_view word, std::string_view label,
                        std::span<const std::string> known) {
    const std::string nearest = nearestName(word, known);
    const std::string question =
        nearest.empty() ? std::string() : fmt::format("did you mean '{}'? ", nearest);
    return fmt::format("; {}{}: {}", question, label, joinNames(known));
}

}  // namespace woodcock
