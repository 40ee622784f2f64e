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

/// Files whose names differ in one number only.
struct FrameSeries {
    std::string before, after;         ///< the text around the number, directories included
    std::vector<std::string> numbers;  ///< as written, in rising order

    std::string name(std::string_view number) const { return before + std::string(number) + after; }
};

/// The files on disk that have a number where `name` has its framePattern(). Empty where there are
/// none.
FrameSeries seriesOfPattern(const std::string& name);

/// The files on disk, `name` among them, that differ from it in the last number of its file's name
/// only. Empty where that has no number.
FrameSeries seriesAround(const std::filesystem::path& name);

/// The first group of two or more of `files` whose names differ in their numbers only, in the order
/// in which they are given. Empty where there is no such group.
std::vector<std::filesystem::path> framesAmong(std::span<const std::filesystem::path> files);

/// The series of `frames` from framesAmong(); absent where they differ in more than one number.
std::optional<FrameSeries> seriesOf(std::span<const std::filesystem::path> frames);

/// "0009 0010 0011", or "{0009..0020}" for many without a gap: the words of a loop in a shell.
std::string shellNumbers(const std::vector<std::string>& numbers);

}  // namespace woodcock
