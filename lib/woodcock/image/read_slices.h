// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace woodcock::image {

/// Pictures of one size as slices of a volume: numbers, not light.
struct Slices {
    int width = 0, height = 0, channels = 0;
    std::uint64_t firstNumber = 0, count = 0;
    /// Slice after slice, row by row from the top left, channels innermost. Integers are scaled to
    /// 0..1; floats are not converted.
    std::vector<float> values;
};

/// True for a file name with ## or %04d where a number goes.
bool hasSliceNumber(const std::filesystem::path& pattern);

/// Reads all files of a pattern, in formats that OpenImage reads: `slice.####.png`, with one # for
/// each digit at least, or `slice.%04d.png`. `report` is called with the fraction that is done; if
/// it throws, reading ends. Errors: Input where there are no such files, numbers in between are
/// missing (it names them), sizes or channels differ, a file cannot be read, or there is not enough
/// memory.
Slices readSlices(const std::filesystem::path& pattern,
                  const std::function<void(double)>& report = {});

/// Reads files whose names differ in one number, in the order of that number. Errors: Input as of
/// readSlices(), and where the names differ in more.
Slices readSliceFiles(const std::vector<std::filesystem::path>& files,
                      const std::function<void(double)>& report = {});

/// Reads the pages of one file, such as a TIFF. Errors: Input as of readSlices(), and where there
/// is only one page.
Slices readPages(const std::filesystem::path& file, const std::function<void(double)>& report = {});

}  // namespace woodcock::image
