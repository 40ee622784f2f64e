// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// World points whose convex hull holds all of the scene's volumes but for their faintest wisps
/// (below 1 % of a grid's largest value), and all surfaces but infinite planes; to frame them
/// tighter than their boxes would. The corners of the unit cube where there is nothing to see.
std::vector<Vec3d> sceneOutline(const SceneDescription& description, const LoadedScene& loaded);

/// World boxes of the instances of a surface, all together; empty for an infinite plane.
Box3d surfaceBounds(const SurfaceDescription& surface, const LoadedSurface& loaded);

/// A world box with room around all of a surface, for what it holds: the surface itself is what
/// bounds that. Below an infinite plane it reaches 1e9 times as far as all there is in the scene.
Box3d spaceAround(const SceneDescription& scene, const LoadedScene& loaded, size_t surface);

}  // namespace woodcock::scene
