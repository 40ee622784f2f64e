// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// Whether a volume, a surface or what a surface holds emits light.
bool anyVolumeOrSurfaceGlows(const SceneDescription& scene);

/// Whether light may come from where nothing covers: what glows, and lights that are seen.
bool anythingGlows(const SceneDescription& scene);

/// Whether no environment is visible to camera rays; lights that are still to be chosen count.
bool environmentIsHidden(const SceneDescription& scene);

}  // namespace woodcock::scene
