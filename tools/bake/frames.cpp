// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/frames.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/parse.h"

namespace woodcock::tool {

namespace {

constexpr double mostFrames = 100000, latest = 1e9;
constexpr std::uint64_t lastNumber = 99999999;

void checkCount(const char* option, const std::string& text, double count) {
    if (count > mostFrames)
        throw usageError("{} {}: these are {:.0f} frames; at most {:.0f} are made at once", option,
                         text, count, mostFrames);
}

std::vector<double> parseTimes(const std::string& text) {
    std::vector<double> parts;
    std::size_t start = 0;
    try {
        for (std::size_t end = 0; end != text.npos; start = end + 1) {
            end = text.find(':', start);
            parts.push_back(parseNumber(text.substr(start, end - start), -latest, latest));
        }
    } catch (const Error& e) {
        throw usageError("--time {}: {}", text, e.what());
    }
    if (parts.size() == 1) return parts;
    if (parts.size() != 3)
        throw usageError("--time {}: expected one time, or FROM:TO:STEP, such as 0:2:0.1", text);
    const auto [from, to, step] = std::tuple(parts[0], parts[1], parts[2]);
    if (!(step > 0))
        throw usageError("--time {}: the step is {:g}; it must be above 0", text, step);
    if (to < from) throw usageError("--time {}: it ends before it begins", text);
    const double count = std::floor((to - from) / step + 1e-9) + 1;  // 0:2:0.1 has 21
    checkCount("--time", text, count);
    std::vector<double> times;
    for (int i = 0; i < static_cast<int>(count); ++i) times.push_back(from + i * step);
    return times;
}

std::pair<int, int> parseFrames(const std::string& text) {
    const std::size_t dash = text.find('-');
    try {
        const auto number = [](const std::string& word) {
            return static_cast<int>(parseCount(word, 0, lastNumber));
        };
        const int first = number(text.substr(0, dash));
        const int last = dash == text.npos ? first : number(text.substr(dash + 1));
        if (last < first) throw usageError("it ends before it begins");
        checkCount("--frames", text, static_cast<double>(last) - first + 1);
        return {first, last};
    } catch (const Error& e) {
        throw usageError("--frames {}: {}; expected FIRST-LAST, such as 1-48", text, e.what());
    }
}

/// Where the frame's number goes, in the file's name; npos: nowhere.
std::size_t placeOfNumber(const std::string& name, std::size_t& digits) {
    const std::size_t first = name.find('#');
    if (first == name.npos) return first;
    const std::size_t end = name.find_first_not_of('#', first);
    digits = (end == name.npos ? name.size() : end) - first;
    return first;
}

}  // namespace

std::vector<BakeFrame> bakeFrames(const FrameOptions& options) {
    if (options.rate && !options.frames)
        throw usageError("--fps is for --frames: it says when a frame is");
    std::vector<BakeFrame> frames;
    if (options.frames) {
        if (options.time)
            throw usageError(
                "--frames and --time contradict each other: frame 1 is at time 0, and --fps says "
                "when the others are; give one of them");
        const auto [first, last] = parseFrames(*options.frames);
        for (int n = first; n <= last; ++n)
            frames.push_back({n, (n - 1) / options.rate.value_or(24)});
        return frames;
    }
    if (!options.time) return {BakeFrame{}};
    const std::vector<double> times = parseTimes(*options.time);
    if (options.time->find(':') == std::string::npos) return {BakeFrame{{}, times.front()}};
    for (std::size_t i = 0; i < times.size(); ++i)
        frames.push_back({static_cast<int>(i) + 1, times[i]});
    return frames;
}

std::filesystem::path frameFile(const std::filesystem::path& file, const BakeFrame& frame) {
    if (!frame.number) return file;
    std::string name = file.filename().string();
    std::size_t digits = 0;
    const std::size_t place = placeOfNumber(name, digits);
    if (place == name.npos) return file;
    return file.parent_path() /
           name.replace(place, digits, fmt::format("{:0{}}", *frame.number, digits));
}

void checkFrameFile(const std::filesystem::path& file, const char* option,
                    const std::vector<BakeFrame>& frames) {
    const std::string name = file.filename().string();
    std::size_t digits = 0;
    const std::size_t place = placeOfNumber(name, digits);
    if (const std::string pattern = framePattern(name);
        pattern.find_first_not_of('#') != pattern.npos)
        throw usageError(
            "{} {}: {} is not filled in, and the file would be called so; put #### where a frame's "
            "number goes",
            option, file.string(), pattern);
    if (!frames.front().number) {
        if (place != name.npos)
            throw usageError(
                "{} {}: {} stands for a frame's number, but one volume is made; say which frames, "
                "by --frames 1-48 or --time 0:2:0.1",
                option, file.string(), std::string(digits, '#'));
        return;
    }
    if (place == name.npos)
        throw usageError(
            "{} {}: there are {} frames and one file; put #### where a frame's number goes, such "
            "as {}.####{}",
            option, file.string(), frames.size(), file.stem().string(), file.extension().string());
    if (name.find('#', place + digits) != name.npos)
        throw usageError("{} {}: a frame's number goes into one place only", option, file.string());
}

}  // namespace woodcock::tool
