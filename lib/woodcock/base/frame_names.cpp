// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/frame_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <regex>

#include "woodcock/base/frame_range.h"

namespace woodcock {
namespace {

/// No file system has longer paths, and the matching of patterns is recursive.
constexpr size_t longestName = 4096;

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// The texts and numbers of a name in turn, beginning with a text: "a.", "0009", ".vdb". A minus
/// behind a dot or an underscore belongs to the number.
std::vector<std::string> splitAtNumbers(const std::string& name) {
    std::vector<std::string> parts{""};
    for (size_t i = 0; i < name.size();) {
        if (!isDigit(name[i])) {
            parts.back() += name[i++];
            continue;
        }
        size_t end = i;
        while (end < name.size() && isDigit(name[end])) ++end;
        std::string number = name.substr(i, end - i);
        std::string& text = parts.back();
        if (text.ends_with(".-") || text.ends_with("_-")) text.pop_back(), number = '-' + number;
        parts.push_back(std::move(number));
        parts.emplace_back();
        i = end;
    }
    return parts;
}

/// The name with its numbers left out: equal for all frames of a series.
std::string skeleton(const std::vector<std::string>& parts) {
    std::string text;
    for (size_t i = 0; i < parts.size(); i += 2) text += parts[i] + '\0';
    return text;
}

std::optional<long long> valueOf(std::string_view number) {
    long long value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc() || end != number.data() + number.size()) return std::nullopt;
    return value;
}

std::optional<int> intOf(std::string_view number) {
    const auto value = valueOf(number);
    if (!value || *value < -largestFrame || *value > largestFrame) return std::nullopt;
    return static_cast<int>(*value);
}

/// A pattern that can be filled in.
struct Place {
    size_t begin, end;  ///< in the name
    int digits;         ///< at least
};

/// The first one from `from` on.
std::optional<Place> findPlace(const std::string& name, size_t from) {
    if (name.size() > longestName) return std::nullopt;
    static const std::regex patterns(
        R"((#{2,}|@{2,})|(^|[/._-])([#@])(?=[/._-]|$)|%(?:0([1-9]|[1-5][0-9]))?d(?![A-Za-z]))"
        R"(|\$F([0-9]{0,2})(?![A-Za-z0-9_])|\$\{F([0-9]{0,2})\}|<(?:f|F|frame|Frame|FRAME)([0-9]{0,2})>)");
    std::smatch match;
    const auto begin = name.begin() + static_cast<std::ptrdiff_t>(from);
    const auto flags =
        from > 0 ? std::regex_constants::match_prev_avail : std::regex_constants::match_default;
    if (!std::regex_search(begin, name.end(), match, patterns, flags)) return std::nullopt;
    const auto at = [&](size_t group) { return from + static_cast<size_t>(match.position(group)); };
    const size_t end = at(0) + static_cast<size_t>(match.length(0));
    if (match[1].matched) return Place{at(1), end, static_cast<int>(match.length(1))};
    if (match[3].matched) return Place{at(3), end, 1};
    for (size_t group = 4; group < match.size(); ++group)
        if (match[group].matched) return Place{at(0), end, intOf(match[group].str()).value_or(1)};
    return Place{at(0), end, 1};
}

/// Compares numbers by value, then by spelling.
bool isBefore(const std::string& a, const std::string& b) {
    const auto x = valueOf(a), y = valueOf(b);
    return x && y && *x != *y ? *x < *y : a < b;
}

void sortNumbers(std::vector<std::string>& numbers) {
    std::sort(numbers.begin(), numbers.end(), isBefore);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

std::string framePattern(std::string_view name) {
    // A single '#' or '@' is a pattern only between separators, as in "x.#.png"; "c#.png" is a
    // name.
    static const std::array<std::regex, 6> patterns{
        std::regex(R"(#{2,}|@{2,})"),
        std::regex(R"((^|[/._-])([#@])(?=[/._-]|$))"),
        std::regex(R"(%[0-9]*d(?![A-Za-z]))"),
        std::regex(R"(\$(F[0-9]*|FF|FRAME|frame)(?![A-Za-z0-9_])|\$\{(F[0-9]*|FF|FRAME|frame)\})"),
        std::regex(R"(<(f|F|frame|Frame|FRAME)[0-9]*>|\{(f|frame|FRAME)(:[^{}]*)?\})"),
        std::regex(R"(\{[0-9]+\.\.[0-9]+\}|\*)")};
    std::cmatch match;
    if (name.size() > longestName) return {};
    for (size_t i = 0; i < patterns.size(); ++i)
        if (std::regex_search(name.data(), name.data() + name.size(), match, patterns[i]))
            return i == 1 ? match[2].str() : match[0].str();
    return {};
}

std::string withFrame(const std::string& name, int frame) {
    std::string filled;
    size_t from = 0;
    while (const auto place = findPlace(name, from)) {
        filled += name.substr(from, place->begin - from);
        filled += fmt::format("{:0{}}", frame, place->digits);
        from = place->end;
    }
    return filled + name.substr(from);
}

bool namesFrame(const std::string& name) { return findPlace(name, 0).has_value(); }

std::vector<int> framesOnDisk(const std::string& name) {
    namespace fs = std::filesystem;
    std::vector<int> frames;
    const auto place = findPlace(name, 0);
    if (!place) return frames;
    // What is in the folder of the first pattern, and has a number there.
    const size_t slash = name.rfind('/', place->begin);
    const size_t start = slash == std::string::npos ? 0 : slash + 1;
    const size_t end = std::min(name.find('/', place->end), name.size());
    const std::string folder = name.substr(0, start);
    const std::string before = name.substr(start, place->begin - start);
    std::error_code none;
    for (fs::directory_iterator file(folder.empty() ? "." : folder, none), last;
         !none && file != last; file.increment(none)) {
        const std::string found = file->path().filename().string();
        if (!found.starts_with(before)) continue;
        size_t digits = before.size() < found.size() && found[before.size()] == '-';
        while (before.size() + digits < found.size() && isDigit(found[before.size() + digits]))
            ++digits;
        const auto frame = intOf(std::string_view(found).substr(before.size(), digits));
        if (!frame || withFrame(name.substr(0, end), *frame) != folder + found) continue;
        if (fs::exists(withFrame(name, *frame), none)) frames.push_back(*frame);
    }
    std::sort(frames.begin(), frames.end());
    return frames;
}

FrameSeries seriesOfPattern(const std::string& name) {
    namespace fs = std::filesystem;
    FrameSeries series;
    const std::string pattern = framePattern(name);
    const size_t at = name.rfind(pattern);
    if (pattern.empty()) return series;
    series.before = name.substr(0, at);
    series.after = name.substr(at + pattern.size());
    if (series.after.find('/') != std::string::npos) return series;  // folders of frames
    const fs::path directory = fs::path(series.before + "x").parent_path();
    const std::string start = fs::path(series.before + "x").filename().string();
    const std::string_view prefix = std::string_view(start).substr(0, start.size() - 1);
    std::error_code none;
    for (fs::directory_iterator file(directory.empty() ? "." : directory, none), end;
         !none && file != end; file.increment(none)) {
        const std::string found = file->path().filename().string();
        if (found.size() <= prefix.size() + series.after.size() || !found.starts_with(prefix) ||
            !found.ends_with(series.after))
            continue;
        std::string number =
            found.substr(prefix.size(), found.size() - prefix.size() - series.after.size());
        const size_t digits = number.front() == '-' ? 1 : 0;
        if (number.size() > digits &&
            std::all_of(number.begin() + static_cast<long>(digits), number.end(), isDigit))
            series.numbers.push_back(std::move(number));
    }
    sortNumbers(series.numbers);
    return series;
}

FrameSeries seriesAround(const std::filesystem::path& name) {
    std::string file = name.stem().string();
    size_t end = file.size();
    while (end > 0 && !isDigit(file[end - 1])) --end;
    size_t begin = end;
    while (begin > 0 && isDigit(file[begin - 1])) --begin;
    if (begin == end || !framePattern(name.string()).empty()) return {};
    file.replace(begin, end - begin, "####");
    return seriesOfPattern((name.parent_path() / file).string() + name.extension().string());
}

std::vector<std::filesystem::path> framesAmong(std::span<const std::filesystem::path> files) {
    std::vector<std::string> names, skeletons;
    for (const auto& file : files) {
        names.push_back(file.lexically_normal().string());
        skeletons.push_back(skeleton(splitAtNumbers(names.back())));
    }
    for (size_t i = 0; i < names.size(); ++i) {
        std::vector<std::filesystem::path> group{names[i]};
        for (size_t k = i + 1; k < names.size(); ++k)
            if (skeletons[k] == skeletons[i] &&
                std::find(group.begin(), group.end(), names[k]) == group.end())
                group.emplace_back(names[k]);
        if (group.size() > 1) return group;
    }
    return {};
}

std::optional<FrameSeries> seriesOf(std::span<const std::filesystem::path> frames) {
    if (frames.size() < 2) return std::nullopt;
    const std::vector<std::string> first = splitAtNumbers(frames.front().string());
    std::optional<size_t> changing;
    FrameSeries series;
    for (const auto& frame : frames) {
        const std::vector<std::string> parts = splitAtNumbers(frame.string());
        if (parts.size() != first.size()) return std::nullopt;
        for (size_t i = 1; i < parts.size(); i += 2) {
            if (parts[i] == first[i]) continue;
            if (changing && *changing != i) return std::nullopt;
            changing = i;
        }
    }
    if (!changing) return std::nullopt;
    for (size_t i = 0; i < first.size(); ++i)
        if (i != *changing) (i < *changing ? series.before : series.after) += first[i];
    for (const auto& frame : frames)
        series.numbers.push_back(splitAtNumbers(frame.string())[*changing]);
    sortNumbers(series.numbers);
    return series;
}

std::optional<std::string> patternOf(const FrameSeries& series) {
    if (series.numbers.empty()) return std::nullopt;
    const size_t digits = series.numbers.front().size();
    for (const std::string& pattern : {std::string(digits, '#'), std::string("%d")}) {
        const std::string name = series.name(pattern);
        const bool each = std::all_of(
            series.numbers.begin(), series.numbers.end(), [&](const std::string& number) {
                const auto value = intOf(number);
                return value && withFrame(name, *value) == series.name(number);
            });
        if (each) return name;
    }
    return std::nullopt;
}

}  // namespace woodcock
