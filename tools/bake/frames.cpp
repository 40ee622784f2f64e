// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/frames.h"

#include <cmath>
#include <tuple>

#include "woodcock/base/error.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/base/parse.h"

namespace woodcock::tool {

namespace {

constexpr double latest = 1e9;

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
    if (count > mostFrames)
        throw usageError("--time {}: these are {:.0f} frames; at most {} are made at once", text,
                         count, mostFrames);
    std::vector<double> times;
    for (int i = 0; i < static_cast<int>(count); ++i) times.push_back(from + i * step);
    return times;
}

}  // namespace

std::vector<BakeFrame> bakeFrames(const FrameOptions& options) {
    if (options.rate && options.frames.empty())
        throw usageError("--fps is for --frames: it says when a frame is");
    std::vector<BakeFrame> frames;
    if (!options.frames.empty()) {
        if (options.time)
            throw usageError(
                "--frames and --time contradict each other: frame 1 is at time 0, and --fps says "
                "when the others are; give one of them");
        for (const int n : options.frames)
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

}  // namespace woodcock::tool
