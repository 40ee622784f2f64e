// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/mapping.h"

#include <algorithm>
#include <cmath>

#include "woodcock/scene/build.h"

namespace woodcock::tool {

CyclesMedium cyclesMedium(Rgb sigmaA, Rgb sigmaS) {
    CyclesMedium medium{.sigmaA = sigmaA, .sigmaS = sigmaS};
    medium.density = (sigmaA + sigmaS).maximum();
    if (medium.density > 0) {
        const double density = medium.density;
        medium.scatterColour =
            Rgb::map([&](int c) { return static_cast<float>(sigmaS[c] / density); });
        medium.absorbColour =
            Rgb::map([&](int c) { return static_cast<float>(1 - sigmaA[c] / density); });
    }
    return medium;
}

CyclesBlackbody cyclesBlackbody(const scene::BlackbodyDescription& blackbody) {
    // Its intensity b means b T^4 + 1 - b: only 1 leaves no rest. The tint may exceed 1.
    return {blackbody.scale, 1, blackbody.colour * static_cast<float>(blackbody.intensity)};
}

Rgb cyclesEmissionWithin(Rgb emission, double ior) {
    return emission * static_cast<float>(1 / (ior * ior));
}

namespace {

std::optional<CyclesPhase> henyeyGreenstein(float g) {
    return CyclesPhase{"", {{"Anisotropy", g}}};
}

std::optional<CyclesPhase> phaseOf(const scene::IsotropicPhase&) { return henyeyGreenstein(0); }
std::optional<CyclesPhase> phaseOf(const scene::HenyeyGreensteinPhase& p) {
    return henyeyGreenstein(p.g);
}
std::optional<CyclesPhase> phaseOf(const scene::RayleighPhase&) {
    return CyclesPhase{"RAYLEIGH", {}};
}
std::optional<CyclesPhase> phaseOf(const scene::DrainePhase& p) {
    return CyclesPhase{"DRAINE", {{"Anisotropy", p.g}, {"Alpha", p.alpha}}};
}
std::optional<CyclesPhase> phaseOf(const scene::MiePhase& p) {
    return CyclesPhase{"MIE", {{"Diameter", p.diameter}}};
}
std::optional<CyclesPhase> phaseOf(const scene::FournierForandPhase& p) {
    return CyclesPhase{"FOURNIER_FORAND", {{"IOR", p.ior}, {"Backscatter", p.backscatter}}};
}
std::optional<CyclesPhase> phaseOf(const scene::TwoLobePhase&) { return std::nullopt; }
std::optional<CyclesPhase> phaseOf(const scene::TablePhase&) { return std::nullopt; }

}  // namespace

std::optional<CyclesPhase> cyclesPhase(float g,
                                       const std::optional<scene::PhaseDescription>& phase) {
    if (!phase) return henyeyGreenstein(g);
    return std::visit([](const auto& p) { return phaseOf(p); }, *phase);
}

int cyclesBounces(std::optional<int> events) {
    return std::min(events.value_or(cyclesMostBounces + 1) - 1, cyclesMostBounces);
}

CyclesColour cyclesColour(Rgb light) {
    const float largest = light.maximum();
    return largest > 0 ? CyclesColour{largest, light * (1 / largest)} : CyclesColour{};
}

CyclesColour cyclesPoint(Rgb intensity) {
    CyclesColour point = cyclesColour(intensity);
    point.strength = static_cast<float>(point.strength * (4 * pi));
    return point;
}

CyclesColour cyclesArea(Rgb radiance, double area) {
    CyclesColour light = cyclesColour(radiance);
    light.strength = static_cast<float>(light.strength * (pi * area));
    return light;
}

Affine3d cyclesLamp(const Affine3d& worldFromLight) {
    const auto& [x, y, z] = worldFromLight.column;
    return {{normalize(x), normalize(z), -normalize(y)}, worldFromLight.translation};
}

Affine3d cyclesImageFromWorld(const scene::EnvironmentDescription& environment) {
    // The light's -z, its image's centre, becomes +x, its +y +z.
    const Affine3d cyclesFromLight{{Vec3d{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}}, {}};
    return cyclesFromLight * scene::worldFromLight(environment).inverse();
}

}  // namespace woodcock::tool
