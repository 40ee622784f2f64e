// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "woodcock/scene/movements.h"

namespace woodcock::tool {

/// A light of a complete scene for tools/blender/render_in_cycles.py, a list: a sky may be two.
/// Throws Error{Input} that names what Cycles cannot express.
nlohmann::json cyclesLight(const scene::SceneDescription& scene, const scene::Movements& movements,
                           std::size_t index);

/// Writes the images of the scene's skies, which that JSON names, into its directory.
void writeCyclesSkies(const std::filesystem::path& directory, const scene::SceneDescription& scene);

}  // namespace woodcock::tool
