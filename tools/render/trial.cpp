// SPDX-License-Identifier: Apache-2.0
#include "tools/render/trial.h"

#include <algorithm>
#include <cmath>

#include "tools/common/interrupt.h"

namespace woodcock::tool {

render::RenderResult renderTrial(const render::Scene& scene,
                                 const render::RenderSettings& settings) {
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
    small.layers = {}, small.mattes.clear(), small.deepError = 0;
    return render::render(scene, small,
                          [](const render::RenderProgress&) { return !interrupted(); });
}

}  // namespace woodcock::tool
