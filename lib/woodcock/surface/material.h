// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "woodcock/surface/texture.h"

namespace woodcock::surface {

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
/// reflectance. Inside is the medium of the surface that has the material.
struct DielectricMaterial {
    double ior = 1.5;
    double roughness = 0;
};
/// Not a surface: only a boundary between media.
struct InterfaceMaterial {};
/// Emits light, and is black otherwise.
struct EmissiveMaterial {
    Texture radiance;
    bool bothSides = false;  ///< else from the outside only
};
/// The second material with the mean of `weight` as its share, the first with the rest.
struct MixMaterial {
    std::uint32_t first = 0, second = 0;  ///< of the scene's materials; neither is a mix itself
    Texture weight{Rgb(0.5f)};
};
using Material = std::variant<DiffuseMaterial, ConductorMaterial, DielectricMaterial,
                              InterfaceMaterial, EmissiveMaterial, MixMaterial>;

}  // namespace woodcock::surface
