// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/cycles/mapping.h"
#include "woodcock/base/error.h"

namespace woodcock::tool {

// What the parts of a scene for Cycles are written with.

inline nlohmann::json toJson(Rgb v) { return {v[0], v[1], v[2]}; }
inline nlohmann::json toJson(Vec3d v) { return {v.x, v.y, v.z}; }
inline nlohmann::json toJson(const Affine3d& m) {
    nlohmann::json rows = nlohmann::json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back({m.column[0][row], m.column[1][row], m.column[2][row], m.translation[row]});
    rows.push_back({0, 0, 0, 1});
    return rows;
}

/// Radiance per unit of length, evenly or times a grid; null where there is none.
inline nlohmann::json emissionJson(Rgb emission, const std::string& grid = "") {
    const CyclesColour glow = cyclesColour(emission);
    if (!(glow.strength > 0)) return nullptr;
    return {{"strength", glow.strength}, {"colour", toJson(glow.colour)}, {"grid", grid}};
}

/// Without scattering, what would scatter is lost to the camera.
inline nlohmann::json mediumJson(Rgb sigmaA, Rgb sigmaS, float g, bool scatters,
                                 Rgb emission = Rgb(0)) {
    if (!scatters) sigmaA += sigmaS, sigmaS = Rgb(0);
    const CyclesMedium medium = cyclesMedium(sigmaA, sigmaS);
    return {{"sigma_a", toJson(medium.sigmaA)},
            {"sigma_s", toJson(medium.sigmaS)},
            {"density", medium.density},
            {"scatter_colour", toJson(medium.scatterColour)},
            {"absorb_colour", toJson(medium.absorbColour)},
            {"scatters", medium.scatters()},
            {"absorbs", medium.absorbs()},
            {"g", g},
            {"emission", emissionJson(emission)}};
}

/// Error{Input} at a place of the scene, which may be unknown.
template <class... A>
Error cyclesRefusal(const std::string& place, fmt::format_string<A...> text, A&&... args) {
    return inputError("{}{}Cycles cannot express {}", place, place.empty() ? "" : ": ",
                      fmt::format(text, std::forward<A>(args)...));
}

}  // namespace woodcock::tool
