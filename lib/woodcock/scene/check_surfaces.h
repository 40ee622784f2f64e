// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// What a surface is by its material, and by what it is to hold.
struct SurfaceNature {
    bool letsLightIn = false;  ///< a dielectric or an interface, or a mixture with one
    /// It parts an inside from an outside, and so has to be closed. Cut-outs, which are mixtures of
    /// an interface with what is no dielectric, do so where they hold something; else they are
    /// sheets with holes in them.
    bool encloses = false;
    bool emits = false;
    double ior = 1;  ///< of what it holds
};
SurfaceNature natureOf(const SceneDescription& scene, size_t surface);
bool anySurfaceEmits(const SceneDescription& scene);

/// "diffuse", as scene files write it.
std::string_view typeName(const MaterialDescription& material);

/// The index of what bears this name; of materials or surfaces.
template <class Named>
std::optional<size_t> findNamed(const std::vector<Named>& all, std::string_view name) {
    for (size_t i = 0; i < all.size(); ++i)
        if (!name.empty() && all[i].name == name) return i;
    return std::nullopt;
}

/// Sees to it that all names lead somewhere, and that surfaces, their materials and what fills them
/// go together, as far as that can be told before anything is loaded. Throws Error{Input} with the
/// place, for the first mistake.
void checkSurfaces(const SceneDescription& scene);

}  // namespace woodcock::scene
