// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/base/spectrum.h"
#include "woodcock/image/film.h"

namespace woodcock::image {

/// What a denoiser made of a film's radiance.
struct DenoisedPicture {
    Film::Window crop;          ///< of the film
    std::vector<float> colour;  ///< red, green and blue of the crop's pixels, row by row
    std::string denoiser;       ///< its name and version
    std::string method;         ///< what it was given, and how it was used, for headers
    double seconds = 0;         ///< that it took

    Rgb radiance(int x, int y) const {
        const auto pixel =
            static_cast<std::size_t>(y - crop.y0) * static_cast<std::size_t>(crop.width()) +
            static_cast<std::size_t>(x - crop.x0);
        return {colour[3 * pixel], colour[3 * pixel + 1], colour[3 * pixel + 2]};
    }
};

}  // namespace woodcock::image
