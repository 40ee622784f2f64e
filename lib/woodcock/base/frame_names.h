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

/// The name with `frame` in place of each pattern that can be filled in: "####" and "@@@@" (as many
/// digits as there are signs), "%d" and "%04d", "$F", "$F4" and "${F4}", "<frame04>", "<f04>" and
/// the like. Larger numbers are written whole, and a minus counts as a digit. Other patterns stay.
std::string withFrame(const std::string& name, int frame);

/// Whether withFrame() fills in anything.
bool namesFrame(const std::string& name);

/// The numbers of the files on disk that withFrame() finds, rising. Folders may hold patterns, too.
std::vector<int> framesOnDisk(const std::string& name);

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

/// "f.####.vdb" of f.0009.vdb and f.0010.vdb, "f.%d.vdb" of f.9.vdb and f.10.vdb: the name with
/// the pattern that withFrame() turns into each of the series. Absent where there is none, as for
/// f.9.vdb beside f.0010.vdb.
std::optional<std::string> patternOf(const FrameSeries& series);

}  // namespace woodcock
