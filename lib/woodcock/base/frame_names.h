// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace woodcock {

/// The part of a name that stands for a frame's number in other programs: "####", "@@@@", "%04d",
/// "$F4", "${FRAME}", "<frame04>", "{frame}", "{0009..0011}", "*". Empty where there is none.
std::string framePattern(std::string_view name);

/// Files whose names differ in nothing but one number.
struct FrameSeries {
    std::string before, after;         ///< what stands around the number, directories included
    std::vector<std::string> numbers;  ///< as written, in rising order

    std::string name(std::string_view number) const { return before + std::string(number) + after; }
};

/// The files on disk that have a number where `name` has its framePattern(); none: none.
FrameSeries seriesOfPattern(const std::string& name);

/// Those among `files` whose names are equal but for their numbers, in the order that they are
/// given; the first such group of two or more different ones. Empty: all differ in more.
std::vector<std::filesystem::path> framesAmong(std::span<const std::filesystem::path> files);

/// The series that `frames` of framesAmong() are, where they differ in one number only.
std::optional<FrameSeries> seriesOf(std::span<const std::filesystem::path> frames);

/// "0009 0010 0011", or "{0009..0020}" for many without a gap, as a shell's loop takes them.
std::string shellNumbers(const std::vector<std::string>& numbers);

}  // namespace woodcock
