// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/scene/description.h"

namespace woodcock::tool {

// Woodcock's parameters in Blender Cycles' terms. The other way: woodcock_addon/mapping.py.

/// What Volume Coefficients takes, sigma_a and sigma_s as they are; and what Volume Scatter and
/// Volume Absorption take, as object densities are those of the world:
/// sigma_s = density x scatterColour, sigma_a = density x (1 - absorbColour).
struct CyclesMedium {
    Rgb sigmaA{0.0f}, sigmaS{0.0f};
    float density = 0;
    Rgb scatterColour{0.0f}, absorbColour{1.0f};
    bool scatters() const { return density > 0 && scatterColour.maximum() > 0; }
    bool absorbs() const { return density > 0 && absorbColour.minimum() < 1; }
};
/// All colours lie in [0, 1].
CyclesMedium cyclesMedium(Rgb sigmaA, Rgb sigmaS);

/// What Principled Volume takes beside a grid of temperatures.
struct CyclesBlackbody {
    double temperature = 1;  ///< multiplies the grid
    double intensity = 1;
    Rgb tint{1.0f};
};
/// Its `offset` has to be 0 and its `scale` no less: Cycles can only multiply.
CyclesBlackbody cyclesBlackbody(const scene::BlackbodyDescription& blackbody);

/// What has to glow inside a dielectric in Cycles, where light that leaves glass keeps the radiance
/// that it had within. Really it has n^2 times that much within.
Rgb cyclesEmissionWithin(Rgb emission, double ior);

/// Cycles clamps g to this, either way.
constexpr float cyclesLargestG = 0.999f;

/// A phase function as the nodes that scatter take it: `type` as Blender names it, and the sockets.
/// Without a type it is Henyey-Greenstein, which all versions have; the others come with 4.3.
struct CyclesPhase {
    std::string type;
    std::vector<std::pair<std::string, double>> inputs;
};
/// Of a volume or an interior: of `phase`, else of Henyey-Greenstein with `g`. Null where Cycles
/// has no such phase function.
std::optional<CyclesPhase> cyclesPhase(float g,
                                       const std::optional<scene::PhaseDescription>& phase);

/// The most bounces of any kind that Blender counts.
constexpr int cyclesMostBounces = 1024;
/// Cycles' m bounces are m + 1 scatterings, or reflections: the last one is still lit by lights.
/// Absent: unlimited. Needs `events` > 0.
int cyclesBounces(std::optional<int> events);

/// A colour of which the largest channel is 1, and what it is to be multiplied by.
struct CyclesColour {
    float strength = 0;
    Rgb colour{1.0f};
};
CyclesColour cyclesColour(Rgb light);

/// Of a point light, and of a spot along its axis: power, 4 pi times the intensity.
CyclesColour cyclesPoint(Rgb intensity);

/// Of an area light: power, pi area times the radiance.
CyclesColour cyclesArea(Rgb radiance, double area);

/// A lamp's world matrix, of unit axes: it shines along its -z. `worldFromLight` shines towards +y;
/// its scale is left out.
Affine3d cyclesLamp(const Affine3d& worldFromLight);

/// Blender's spots are no narrower than a degree.
constexpr double cyclesNarrowestCone = 1;

/// Turns a world direction to where Cycles looks it up in an environment image: the image's centre
/// is towards +x, its top +z and its left +y there.
Affine3d cyclesImageFromWorld(const scene::EnvironmentDescription& environment);

}  // namespace woodcock::tool
