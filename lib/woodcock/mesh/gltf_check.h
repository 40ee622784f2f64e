// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace woodcock {

/// Throws Error{Input} where the JSON of a glTF file (.gltf, or the first part of a .glb) nests, or
/// its nodes follow each other, deeper than anybody writes: Assimp's reader calls itself for each
/// level. Other mistakes are left for it to find.
void refuseDeepGltf(const std::filesystem::path& file);

}  // namespace woodcock
