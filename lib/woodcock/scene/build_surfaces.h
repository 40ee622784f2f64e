// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "woodcock/light/mesh_light.h"
#include "woodcock/medium/medium.h"
#include "woodcock/scene/load.h"
#include "woodcock/surface/surface_set.h"

namespace woodcock::scene {

struct BuiltSurfaces {
    std::shared_ptr<const surface::SurfaceSet> set;  ///< null: none
    std::vector<medium::Medium> interiorMedia;       ///< as of Scene
    std::vector<light::MeshLight::Triangle> emitters;
    light::MeshLight::RadianceAt radianceAt;  ///< of the emitters; empty where none varies
};

/// The surfaces of a scene, what they hold, and the triangles that emit light: those of all
/// emissive instances, in the order of instances and of their triangles. Throws Error{Input} on
/// transforms that flatten a surface, and where there are more emitters than can be counted.
BuiltSurfaces buildSurfaces(const SceneDescription& description, const LoadedScene& loaded);

}  // namespace woodcock::scene
