// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/graded_image.h"

#include <cmath>

namespace woodcock::light {

std::vector<float> gradedImage(Rgb below, Rgb horizon, Rgb above) {
    const double width = 12 / std::sqrt(std::log(2.0));
    std::vector<float> pixels;
    for (int y = 0; y < gradedImageHeight; ++y) {
        const double elevation = 90 - 180 * (y + 0.5) / gradedImageHeight;
        const auto share = static_cast<float>(std::exp(-std::pow(elevation / width, 2)));
        const Rgb end = elevation > 0 ? above : below;
        for (int x = 0; x < gradedImageWidth; ++x)
            for (int c = 0; c < 3; ++c) pixels.push_back(end[c] + (horizon[c] - end[c]) * share);
    }
    return pixels;
}

}  // namespace woodcock::light
