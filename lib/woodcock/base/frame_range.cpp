// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <unordered_set>

#include "woodcock/base/error.h"

namespace woodcock {
namespace {

/// A part of a range between commas.
class Part {
public:
    explicit Part(std::string_view text) : text_(text), rest_(text) {}

    std::vector<int> frames() {
        const int first = number();
        if (rest_.empty()) return {first};
        take('-');
        const int last = number();
        const int count = std::abs(last - first) + 1;
        if (rest_.empty()) return every(first, last, 1);
        const char kind = rest_.front();
        if (kind != 'x' && kind != 'y' && kind != ':') throw mistake("");
        rest_.remove_prefix(1);
        const int step = number();
        if (!rest_.empty()) throw mistake("");
        if (step < 1)
            throw mistake(
                fmt::format(": the step is {}, and must be 1 or more; {}-{} counts {} by itself",
                            step, first, last, first > last ? "down" : "up"));
        checkCount(kind == 'x' ? (count - 1) / step + 1 : count);
        if (kind == 'x') return every(first, last, step);
        return kind == 'y' ? others(first, last, step) : refined(first, last, step);
    }

private:
    int number() {
        int value = 0;
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (error == std::errc::result_out_of_range || std::abs(value) > largestFrame)
            throw mistake(
                fmt::format(": frames are numbered from {} to {}", -largestFrame, largestFrame));
        if (error != std::errc()) throw mistake("");
        rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
        return value;
    }
    void take(char c) {
        if (!rest_.starts_with(c)) throw mistake("");
        rest_.remove_prefix(1);
    }
    Error mistake(const std::string& why) const {
        if (!why.empty()) return usageError("'{}'{}", text_, why);
        return usageError(
            "'{}' is no frame and no range; expected such as 12, 1-48, 10-1, 1-48x2 (every second) "
            "or 1-48y2 (the others), with commas between them",
            text_);
    }
    void checkCount(long long count) const {
        if (count > mostFrames)
            throw mistake(fmt::format(": these are {} frames; at most {} are made at once", count,
                                      mostFrames));
    }
    std::vector<int> every(int first, int last, int step) const {
        checkCount(std::abs(last - first) / step + 1);
        std::vector<int> frames;
        for (int n = first; first <= last ? n <= last : n >= last;
             n += first <= last ? step : -step)
            frames.push_back(n);
        return frames;
    }
    std::vector<int> others(int first, int last, int step) const {
        std::vector<int> frames = every(first, last, 1);
        std::erase_if(frames, [&](int n) { return std::abs(n - first) % step == 0; });
        if (frames.empty())
            throw mistake(
                fmt::format(" leaves no frame: y{} takes all but every {}", step,
                            step == 1 ? "one" : fmt::format("{}th, counted from the first", step)));
        return frames;
    }
    std::vector<int> refined(int first, int last, int step) const {
        std::vector<int> frames;
        std::unordered_set<int> known;
        for (step = std::min(step, std::abs(last - first) + 1); step >= 1; --step)
            for (const int n : every(first, last, step))
                if (known.insert(n).second) frames.push_back(n);
        return frames;
    }

    std::string_view text_, rest_;
};

}  // namespace

std::vector<int> parseFrameRange(std::string_view text) {
    std::vector<int> frames;
    std::unordered_set<int> known;
    for (size_t start = 0, end = 0; end != text.npos; start = end + 1) {
        end = text.find(',', start);
        for (const int n : Part(text.substr(start, end - start)).frames())
            if (known.insert(n).second) frames.push_back(n);
        if (frames.size() > static_cast<size_t>(mostFrames))
            throw usageError(
                "'{}': these are more than {} frames; at most so many are made at once", text,
                mostFrames);
    }
    return frames;
}

std::string frameRangeText(std::vector<int> frames) {
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    std::string text;
    for (size_t i = 0; i < frames.size();) {
        size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        text += fmt::format("{}{}", text.empty() ? "" : ",", frames[i]);
        if (end - i > 1) text += fmt::format("-{}", frames[end - 1]);
        i = end;
    }
    return text;
}

}  // namespace woodcock
