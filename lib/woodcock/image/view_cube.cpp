// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/view_cube.h"

#include <algorithm>
#include <cmath>

namespace woodcock::image {

ViewCube bakeView(const DisplayTransform& transform) {
    ViewCube cube;
    std::vector<float> light;
    for (int i = 0; i < cube.side; ++i)
        light.push_back(
            static_cast<float>(std::exp2(cube.low + i * (cube.high - cube.low) / (cube.side - 1)) -
                               std::exp2(cube.low)));
    std::vector<float> rgba;
    for (const float b : light)
        for (const float g : light)
            for (const float r : light) rgba.insert(rgba.end(), {r, g, b, 1});
    transform.apply(rgba);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3)
            cube.rgb.push_back(static_cast<unsigned char>(std::lround(
                255 * std::clamp(std::isfinite(rgba[i]) ? rgba[i] : 0.0f, 0.0f, 1.0f))));
    return cube;
}

}  // namespace woodcock::image
