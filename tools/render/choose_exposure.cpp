// SPDX-License-Identifier: Apache-2.0
#include "tools/render/choose_exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "tools/common/interrupt.h"

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

double chooseExposure(const render::Scene& scene, const render::RenderSettings& settings,
                      const image::DisplayTransform& display) {
    constexpr double pixels = 96 * 54;
    constexpr int samples = 16;
    render::RenderSettings small = settings;
    const double share = std::sqrt(pixels / (double(settings.width) * settings.height));
    const auto scaled = [&](int side) {
        return std::max(9, static_cast<int>(std::lround(side * share)));
    };
    small.width = scaled(settings.width), small.height = scaled(settings.height);
    small.crop.reset();
    small.firstSample = 0, small.endSample = samples;
    small.adaptive = false, small.timeLimit = 0, small.noise = 0;
    small.depthLayers = small.featureLayers = false;
    const double bright =
        brightRadiance(render::render(scene, small, [](const render::RenderProgress&) {
                           return !interrupted();
                       }).film);
    if (!(bright > 0)) return 0;
    double low = -10, high = 10;  // displays show more light brighter
    while (high - low > 0.01) {
        const double stops = (low + high) / 2;
        (shown(display, bright * std::exp2(stops)) < brightDisplayValue ? low : high) = stops;
    }
    return std::round(low * 20) / 20 + 0.0;  // no negative zero
}

}  // namespace woodcock::tool
