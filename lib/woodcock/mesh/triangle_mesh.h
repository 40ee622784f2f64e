// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock {

/// Points of one position are one point, so that triangles that meet share their edges.
struct TriangleMesh {
    std::vector<Vec3f> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of three different points each
};

/// Whether this build can read meshes of all formats: it was made with Assimp. PLY needs none.
bool canReadMeshes();

/// All triangles of an OBJ, PLY, STL or glTF file (.gltf, .glb), each part where its nodes put it;
/// faces of more corners are cut into triangles. The file's own axes and units are kept.
/// Errors: Input, naming the file and what is wrong with it; Failure where this build has no Assimp
/// or the mesh does not fit into memory.
TriangleMesh readMesh(const std::filesystem::path& file);

/// Edges that belong to one triangle only: a mesh that has them encloses nothing.
struct OpenEdges {
    std::size_t count = 0;
    Vec3f first;  ///< the middle of the first one
};
OpenEdges findOpenEdges(const TriangleMesh& mesh);

/// Makes points of one position one, and drops triangles that lose a corner by it.
TriangleMesh weld(const TriangleMesh& mesh);

Box3d boundsOf(const TriangleMesh& mesh);

}  // namespace woodcock
