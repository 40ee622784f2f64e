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

}  // namespace woodcock::scene
