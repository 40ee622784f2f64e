// SPDX-License-Identifier: Apache-2.0
#include "tools/render/choose_exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace woodcock::tool {

namespace {

/// The display value of a grey.
double shown(const image::DisplayTransform& display, double radiance) {
    const auto grey = static_cast<float>(radiance);
    std::array<float, 4> pixel{grey, grey, grey, 1};
    display.apply(pixel);
    return (double{pixel[0]} + double{pixel[1]} + double{pixel[2]}) / 3;
}

}  // namespace

double brightRadiance(const image::Film& film) {
    constexpr int side = 3;
    std::vector<std::pair<double, double>> blocks;  // radiance, weight
    double sum = 0;
    for (int y = 0; y + side <= film.height(); y += side)
        for (int x = 0; x + side <= film.width(); x += side) {
            double radiance = 0, weight = 0;
            for (int i = 0; i < side * side; ++i) {
                const auto pixel = film.foreground(x + i % side, y + i / side);
                radiance += pixel.radiance, weight += pixel.coverage;
            }
            if (!(weight > 0)) continue;
            blocks.emplace_back(radiance / weight, weight);
            sum += weight;
        }
    std::sort(blocks.begin(), blocks.end());
    double below = 0;
    for (const auto& [radiance, weight] : blocks)
        if ((below += weight) >= brightShare * sum) return radiance;
    return 0;
}

double chooseExposure(const image::Film& trial, const image::DisplayTransform& display) {
    const double bright = brightRadiance(trial);
    if (!(bright > 0)) return 0;
    double low = -10, high = 10;  // displays show more light brighter
    while (high - low > 0.01) {
        const double stops = (low + high) / 2;
        (shown(display, bright * std::exp2(stops)) < brightDisplayValue ? low : high) = stops;
    }
    return std::round(low * 20) / 20 + 0.0;  // no negative zero
}

}  // namespace woodcock::tool
