// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "woodcock/base/vec.h"
#include "woodcock/mesh/surface_mesh.h"

// What mesh_read.cpp needs of single formats.

namespace woodcock::mesh {

/// The faces of a PLY file, cut into triangles, in the file's own units; with the normals and
/// texture coordinates of its vertices where it has them. Errors: Input.
SurfaceMesh readPlyMesh(const std::filesystem::path& file);

/// The text of a mesh with its origin taken off, for readers that keep floats only.
struct FarText {
    std::string text;
    Vec3d origin;
};

/// The text of an OBJ file, or of an STL file of text, with its origin taken off in double. Absent
/// where floats hold the points well enough (originFor), for other files, and where the text is
/// written in an unusual way. Errors: as of readInput().
std::optional<FarText> withoutOrigin(const std::filesystem::path& file);

/// Throws Error{Input} where the JSON of a glTF file (.gltf, or the first part of a .glb) or its
/// chain of nodes is deeper than anybody writes: Assimp's reader calls itself for each level.
/// Assimp finds other mistakes.
void refuseDeepGltf(const std::filesystem::path& file);

}  // namespace woodcock::mesh
