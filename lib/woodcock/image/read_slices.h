// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace woodcock {

/// Pictures of one size as slices of a volume: numbers, not light.
struct Slices {
    int width = 0, height = 0, channels = 0;
    std::uint64_t firstNumber = 0, count = 0;
    /// Slice after slice, row by row from the top left, channels innermost. Integers are scaled to
    /// 0..1, floats are as they are.
    std::vector<float> values;
};

/// True for a file name with ## or %04d where a number goes.
bool hasSliceNumber(const std::filesystem::path& pattern);

/// Reads all files of the pattern, of the formats that OpenImage takes: `slice.####.png`, one # for
/// each digit at least, or `slice.%04d.png`. `report` is called with the share that is done; what
/// it throws ends the reading. Errors: Input where there are no such files, numbers are missing in
/// between (naming them), sizes or channels differ, a file cannot be read, or memory does not
/// suffice.
Slices readSlices(const std::filesystem::path& pattern,
                  const std::function<void(double)>& report = {});

/// Reads the files of a list, whose names differ in one number: in its order, whatever the list's.
/// Errors: Input as readSlices(), and where the names differ in more.
Slices readSliceFiles(const std::vector<std::filesystem::path>& files,
                      const std::function<void(double)>& report = {});

/// Reads the pages of one file, as a TIFF has several. Errors: Input as readSlices(), and where
/// there is but one.
Slices readPages(const std::filesystem::path& file, const std::function<void(double)>& report = {});

}  // namespace woodcock
