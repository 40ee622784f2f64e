// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// The files that a scene reads, but for the OpenColorIO config: of volumes, lights, materials and
/// surfaces.
std::vector<std::filesystem::path*> sceneFiles(SceneDescription& scene);

}  // namespace woodcock::scene
