// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "woodcock/scene/load.h"
#include "woodcock/surface/material.h"

namespace woodcock::scene {

/// The materials in the order of the description, and after them the one of surfaces that name
/// none.
std::vector<surface::Material> buildMaterials(const SceneDescription& description,
                                              const LoadedScene& loaded);

/// Of that list; the empty name is the default's.
std::uint32_t materialIndex(const SceneDescription& description, std::string_view name);

/// What a surface sends out.
struct Emission {
    Rgb radiance{0.0f};
    bool bothSides = false;
};

/// At texture coordinates, from the side that it faces or from the other.
Emission emissionAt(const std::vector<surface::Material>& materials, std::uint32_t material,
                    double u, double v, bool front);

/// Whether that is not the same everywhere and from both sides.
bool emissionVaries(const std::vector<surface::Material>& materials, std::uint32_t material);

/// Of each triangle of a mesh of this material, textures averaged over it; empty where all are
/// dark.
std::vector<Emission> meanEmission(const std::vector<surface::Material>& materials,
                                   std::uint32_t material, const mesh::SurfaceMesh& mesh);

}  // namespace woodcock::scene
