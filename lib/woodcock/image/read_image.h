// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "woodcock/base/spectrum.h"

namespace woodcock::image {

/// Scene-linear light, row by row from the top left.
struct Image {
    int width = 0, height = 0;
    std::vector<float> rgb;  ///< width x height x 3

    Rgb at(int x, int y) const {
        const std::size_t i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x)) *
                              3;
        return {rgb[i], rgb[i + 1], rgb[i + 2]};
    }
};

/// Reads an image as light, in any format that OpenImage reads. One channel is grey; alpha and
/// further channels are ignored; numbers are not converted. Throws Error{Input} on a file that
/// cannot be read, and on negative, NaN or infinite values, with their number and the position of
/// the first.
Image readImage(const std::filesystem::path& file);

}  // namespace woodcock::image
