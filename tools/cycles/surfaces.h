// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "woodcock/scene/load.h"
#include "woodcock/scene/movements.h"

namespace woodcock::tool {

/// The surfaces of a complete scene for tools/blender/render_in_cycles.py, a list. Throws
/// Error{Input} that names what Cycles cannot express.
nlohmann::json cyclesSurfaces(const scene::SceneDescription& scene,
                              const scene::LoadedScene& loaded, const scene::Movements& movements);

/// Writes the mesh of each as `directory`/surface<number>.mesh, numbers of this machine: the counts
/// of points, triangles and of those with normals and with texture coordinates (all or none) as 32
/// bits each, then points (3 floats), corners of triangles (3 x 32 bits), normals (9 floats) and
/// texture coordinates (6 floats).
void writeCyclesMeshes(const std::filesystem::path& directory, const scene::SceneDescription& scene,
                       const scene::LoadedScene& loaded);

}  // namespace woodcock::tool
