// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_slices.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock {

namespace fs = std::filesystem;

namespace {

struct NumberPlace {
    std::string before, after;
    std::size_t digits = 0;
};

std::optional<NumberPlace> findNumber(const std::string& name) {
    if (const std::size_t hash = name.find('#'); hash != name.npos) {
        const std::size_t end = std::min(name.find_first_not_of('#', hash), name.size());
        return NumberPlace{name.substr(0, hash), name.substr(end), end - hash};
    }
    // %d or %04d
    const std::size_t percent = name.find('%');
    if (percent == name.npos) return {};
    std::size_t at = percent + 1;
    std::size_t digits = 1;
    if (at + 1 < name.size() && name[at] == '0' && name[at + 1] >= '1' && name[at + 1] <= '9') {
        digits = static_cast<std::size_t>(name[at + 1] - '0');
        at += 2;
    }
    if (at >= name.size() || name[at] != 'd') return {};
    return NumberPlace{name.substr(0, percent), name.substr(at + 1), digits};
}

/// The number in `name`, where it is one of the pattern's: padded to its digits and no more.
std::optional<std::uint64_t> numberOf(const std::string& name, const NumberPlace& place) {
    if (name.size() < place.before.size() + place.after.size() + place.digits ||
        !name.starts_with(place.before) || !name.ends_with(place.after))
        return {};
    const std::string text =
        name.substr(place.before.size(), name.size() - place.before.size() - place.after.size());
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    if (text.size() > place.digits && text[0] == '0') return {};
    return number;
}

std::map<std::uint64_t, fs::path> findSlices(const fs::path& pattern) {
    const std::optional<NumberPlace> place = findNumber(pattern.filename().string());
    if (!place) throw inputError("'{}' has no place for a number: #### or %04d", pattern.string());
    const fs::path directory = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
    std::error_code error;
    std::map<std::uint64_t, fs::path> slices;
    for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
        if (const auto number = numberOf(it->path().filename().string(), *place))
            slices[*number] = it->path();
    if (error)
        throw inputError("cannot look for '{}': directory '{}': {}", pattern.string(),
                         directory.string(), error.message());
    if (slices.empty()) throw inputError("there are no files '{}'", pattern.string());
    return slices;
}

void requireNoGaps(const std::map<std::uint64_t, fs::path>& slices, const fs::path& pattern) {
    std::string missing;
    int gaps = 0;
    for (auto it = slices.begin(), after = std::next(it); after != slices.end(); ++it, ++after) {
        if (after->first == it->first + 1) continue;
        if (++gaps > 10) break;
        const std::uint64_t first = it->first + 1, last = after->first - 1;
        missing +=
            (missing.empty() ? "" : ", ") +
            (first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last));
    }
    if (gaps > 0)
        throw inputError("slices of '{}' are missing between {} and {}: {}{}", pattern.string(),
                         slices.begin()->first, slices.rbegin()->first, missing,
                         gaps > 10 ? " and more" : "");
}

void prepare(Slices& slices, const OIIO::ImageSpec& spec, const fs::path& pattern) {
    slices.width = spec.width;
    slices.height = spec.height;
    slices.channels = spec.nchannels;
    const double values = static_cast<double>(spec.width) * spec.height * spec.nchannels *
                          static_cast<double>(slices.count);
    const auto limit = static_cast<double>(memoryLimit());
    if (values * sizeof(float) > limit)
        throw inputError(
            "'{}': {} slices of {} x {} with {} channels need {} of memory, and there "
            "are {}",
            pattern.string(), slices.count, spec.width, spec.height, spec.nchannels,
            formatGiB(values * sizeof(float)), formatGiB(limit));
    slices.values.resize(static_cast<std::size_t>(values));
}

}  // namespace

bool hasSliceNumber(const fs::path& pattern) {
    return findNumber(pattern.filename().string()).has_value();
}

Slices readSlices(const fs::path& pattern, const std::function<void(double)>& report) {
    const std::map<std::uint64_t, fs::path> files = findSlices(pattern);
    requireNoGaps(files, pattern);
    Slices slices;
    slices.firstNumber = files.begin()->first;
    slices.count = files.size();
    float* to = nullptr;
    std::uint64_t done = 0;
    for (const auto& [number, file] : files) {
        OpenImage input(file, "slice");
        const OIIO::ImageSpec& spec = input.spec();
        if (done == 0) {
            prepare(slices, spec, pattern);
            to = slices.values.data();
        }
        if (spec.width != slices.width || spec.height != slices.height ||
            spec.nchannels != slices.channels)
            throw inputError("slice '{}' is {} x {} with {} channels; '{}' is {} x {} with {}",
                             file.string(), spec.width, spec.height, spec.nchannels,
                             files.begin()->second.string(), slices.width, slices.height,
                             slices.channels);
        input.read(to);
        to += slices.values.size() / slices.count;
        if (report)
            report(static_cast<double>(++done) / static_cast<double>(slices.count));
        else
            ++done;
    }
    return slices;
}

}  // namespace woodcock
