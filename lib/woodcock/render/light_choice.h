// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "woodcock/light/light_set.h"

namespace woodcock::render {

/// Power heuristic of two sampling densities: Veach 1997, eq. 9.13.
inline double powerHeuristic(double own, double other) {
    if (!(own > 0)) return 0;
    const double r = other / own;
    return 1 / (1 + r * r);
}

/// Next-event estimation's choice of a light, with its probability. One object for each thread.
class LightChoice {
public:
    explicit LightChoice(const light::LightSet& lights)
        : lights_(lights), pick_(std::max<std::size_t>(lights.sampled().size(), 1)) {}

    struct Chosen {
        int light;
        double probability;
    };
    std::optional<Chosen> choose(const light::ScatterPoint& from, double u) {
        const auto sampled = lights_.sampled();
        lights_.pickProbabilities(from, pick_);
        std::size_t k = 0;
        while (k + 1 < sampled.size() && u >= pick_[k]) u -= pick_[k++];
        if (!(pick_[k] > 0)) return {};
        return Chosen{sampled[k], pick_[k]};
    }

    double probability(int light, const light::ScatterPoint& from) {
        const auto sampled = lights_.sampled();
        lights_.pickProbabilities(from, pick_);
        for (std::size_t i = 0; i < sampled.size(); ++i)
            if (sampled[i] == light) return pick_[i];
        return 0;
    }

    /// The density, per steradian, with which next-event estimation at `from` would sample this
    /// direction to this light.
    double pdf(int light, const light::ScatterPoint& from, Vec3d direction) {
        const double pdf = lights_.pdf(light, from.position, direction, from.time);
        return pdf > 0 ? pdf * probability(light, from) : 0;
    }

private:
    const light::LightSet& lights_;
    std::vector<float> pick_;  // one for each; a 0 where there are none
};

}  // namespace woodcock::render
