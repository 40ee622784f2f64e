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

namespace woodcock::image {

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

/// The number in `name`, where it matches the pattern: padded to exactly its digits.
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
    if (!place)
        throw inputError("'{}' has no pattern for a number: #### or %04d", pattern.string());
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

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// A name, split into texts and the runs of digits between them.
struct SplitName {
    std::vector<std::string> texts, digits;
};

SplitName split(const std::string& name) {
    SplitName parts;
    parts.texts.emplace_back();
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (!isDigit(name[i])) {
            parts.texts.back() += name[i];
            continue;
        }
        if (i == 0 || !isDigit(name[i - 1])) {
            parts.digits.emplace_back();
            parts.texts.emplace_back();
        }
        parts.digits.back() += name[i];
    }
    return parts;
}

std::uint64_t numberOf(const std::string& digits, const fs::path& file) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size())
        throw inputError("'{}' has a number that is too long", file.string());
    return number;
}

/// The run of digits that differs between the files.
std::size_t findRun(const std::vector<fs::path>& files) {
    const SplitName first = split(files.front().filename().string());
    std::optional<std::size_t> run;
    for (const fs::path& file : files) {
        const SplitName parts = split(file.filename().string());
        bool alike = parts.texts == first.texts && file.parent_path() == files[0].parent_path();
        for (std::size_t i = 0; alike && i < parts.digits.size(); ++i) {
            if (parts.digits[i] == first.digits[i]) continue;
            alike = !run || *run == i;
            run = i;
        }
        if (!alike)
            throw inputError(
                "'{}' and '{}' are not slices of one volume: their names must differ in one number "
                "only, and be in one folder",
                files.front().string(), file.string());
    }
    if (!run) throw inputError("'{}' is given more than once", files.front().string());
    return *run;
}

std::map<std::uint64_t, fs::path> sortSlices(const std::vector<fs::path>& files) {
    const std::size_t run = findRun(files);
    std::map<std::uint64_t, fs::path> slices;
    for (const fs::path& file : files) {
        const std::uint64_t number = numberOf(split(file.filename().string()).digits[run], file);
        const auto [other, isNew] = slices.emplace(number, file);
        if (!isNew)
            throw inputError("'{}' and '{}' have the same number, {}", other->second.string(),
                             file.string(), number);
    }
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

namespace {

Slices readNumbered(const std::map<std::uint64_t, fs::path>& files, const fs::path& pattern,
                    const std::function<void(double)>& report) {
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

/// The number of pages of a file. Bounded, as a damaged file may claim any number.
std::uint64_t countPages(OpenImage& input) {
    constexpr int most = 1 << 20;
    int pages = 0;
    while (pages < most && input.goTo(pages)) ++pages;
    return static_cast<std::uint64_t>(pages);
}

}  // namespace

Slices readSlices(const fs::path& pattern, const std::function<void(double)>& report) {
    return readNumbered(findSlices(pattern), pattern, report);
}

Slices readSliceFiles(const std::vector<fs::path>& files,
                      const std::function<void(double)>& report) {
    return readNumbered(sortSlices(files), files.front(), report);
}

Slices readPages(const fs::path& file, const std::function<void(double)>& report) {
    OpenImage input(file, "stack of slices");
    const std::string imageJ = input.spec().get_string_attribute("ImageDescription");
    Slices slices;
    slices.count = countPages(input);
    if (slices.count < 2) {
        if (imageJ.starts_with("ImageJ=") && imageJ.find("images=") != imageJ.npos)
            throw inputError(
                "'{}' is a stack that ImageJ wrote beyond TIFF's own limits, as one page and "
                "numbers without a header; save it as an image sequence",
                file.string());
        throw inputError(
            "'{}' is one picture, and a volume needs several: if each slice is a file, name all of "
            "them, such as slice.####{}",
            file.string(), file.extension().string());
    }
    for (std::uint64_t page = 0; page < slices.count; ++page) {
        input.goTo(static_cast<int>(page));
        const OIIO::ImageSpec& spec = input.spec();
        if (page == 0) prepare(slices, spec, file);
        if (spec.width != slices.width || spec.height != slices.height ||
            spec.nchannels != slices.channels)
            throw inputError(
                "page {} of '{}' is {} x {} with {} channels; its first is {} x {} with {}",
                page + 1, file.string(), spec.width, spec.height, spec.nchannels, slices.width,
                slices.height, slices.channels);
        input.read(slices.values.data() + page * (slices.values.size() / slices.count));
        if (report) report(static_cast<double>(page + 1) / static_cast<double>(slices.count));
    }
    return slices;
}

}  // namespace woodcock::image
