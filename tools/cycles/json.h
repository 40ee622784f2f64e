// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cycles/mapping.h"
#include "woodcock/base/error.h"
#include "woodcock/scene/keys/sections.h"

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
inline nlohmann::json mediumJson(Rgb sigmaA, Rgb sigmaS, const CyclesPhase& phase, bool scatters,
                                 Rgb emission = Rgb(0)) {
    if (!scatters) sigmaA += sigmaS, sigmaS = Rgb(0);
    const CyclesMedium medium = cyclesMedium(sigmaA, sigmaS);
    nlohmann::json inputs = nlohmann::json::object();
    for (const auto& [socket, value] : phase.inputs) inputs[socket] = value;
    return {{"sigma_a", toJson(medium.sigmaA)},
            {"sigma_s", toJson(medium.sigmaS)},
            {"density", medium.density},
            {"scatter_colour", toJson(medium.scatterColour)},
            {"absorb_colour", toJson(medium.absorbColour)},
            {"scatters", medium.scatters()},
            {"absorbs", medium.absorbs()},
            {"phase", {{"type", phase.type}, {"inputs", inputs}}},
            {"emission", emissionJson(emission)}};
}

/// Error{Input} at a place of the scene, which may be unknown.
template <class... A>
Error cyclesRefusal(const std::string& place, fmt::format_string<A...> text, A&&... args) {
    return inputError("{}{}Cycles cannot express {}", place, place.empty() ? "" : ": ",
                      fmt::format(text, std::forward<A>(args)...));
}

/// The phase function of `d`, a volume or an interior, whose member's place in the scene is
/// place(member). Throws where Cycles has none like it.
template <class D, class Place>
CyclesPhase phaseFor(const D& d, Place place) {
    const auto phase = cyclesPhase(d.g, d.phase);
    if (!phase)
        throw cyclesRefusal(place(d.phase), "a phase function of type {}", scene::tagOf(*d.phase));
    for (const auto& [socket, value] : phase->inputs)
        if (socket == "Anisotropy" && std::abs(value) > double{cyclesLargestG})
            throw cyclesRefusal(d.phase ? place(d.phase) : place(d.g),
                                "a g of {:.6g}: it clamps g to +-{}", value, cyclesLargestG);
    return *phase;
}

}  // namespace woodcock::tool
