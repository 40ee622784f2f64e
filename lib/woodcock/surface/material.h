// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "woodcock/surface/texture.h"

namespace woodcock {

/// Lambert: the same radiance in all directions of the side that is lit.
struct DiffuseMaterial {
    Texture colour{Rgb(0.8f)};  ///< albedo, at most 1
};
/// Metal: GGX facets of roughness (alpha = roughness^2; 0: a mirror). With `fresnelColour` their
/// reflectance at normal incidence by Schlick's approximation; else by eta and k, exactly.
struct ConductorMaterial {
    bool schlick = true;
    Texture fresnelColour{Rgb(0.9f)};
    Rgb eta{1.0f}, k{0.0f};
    double roughness = 0;
};
/// Glass, water: GGX facets between two indices of refraction, with the exact unpolarised Fresnel
/// reflectance; what is inside is the medium of the surface that bears it.
struct DielectricMaterial {
    double ior = 1.5;
    double roughness = 0;
};
/// No surface: a mere boundary between media.
struct InterfaceMaterial {};
/// Light, and black otherwise.
struct EmissiveMaterial {
    Texture radiance;
    bool bothSides = false;  ///< else from the outside alone
};
/// The second material with the weight's mean, the first with the rest.
struct MixMaterial {
    std::uint32_t first = 0, second = 0;  ///< of the scene's materials; each no mix itself
    Texture weight{Rgb(0.5f)};
};
using Material = std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial,
                              InterfaceMaterial, EmissiveMaterial, MixMaterial>;

}  // namespace woodcock
