// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::mesh {

/// Points of one position are one point, so that triangles that meet share their edges.
struct TriangleMesh {
    std::vector<Vec3f> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of three different points each
    /// The position of point (0, 0, 0). It is not zero where a mesh is so far away that floats
    /// would lose its digits; it is taken off before anything is rounded.
    Vec3d origin{};
};

/// Whether this build can read meshes of all formats: it was made with Assimp. PLY needs none.
bool canReadMeshes();

/// All triangles of an OBJ, PLY, STL or glTF file (.gltf, .glb), each part transformed by its
/// nodes; other faces are cut into triangles. The file's own axes and units are kept. Errors:
/// Input, naming the file and what is wrong with it; Failure where this build has no Assimp or the
/// mesh does not fit into memory.
TriangleMesh readMesh(const std::filesystem::path& file);

/// Edges that belong to one triangle only: a mesh that has them encloses nothing.
struct OpenEdges {
    std::size_t count = 0;
    Vec3f first;  ///< the middle of the first one, without the mesh's origin
};
OpenEdges findOpenEdges(const TriangleMesh& mesh);

/// Merges points of equal position, and drops triangles that lose a corner by that.
TriangleMesh weld(const TriangleMesh& mesh);

/// The bounds of the points, without their origin.
Box3d boundsOf(const TriangleMesh& mesh);

/// The origin of points in `bounds`: zero, or their rounded middle where they lie so far away that
/// floats would move them by more than a 100,000th of their extent.
Vec3d originFor(const Box3d& bounds);

}  // namespace woodcock::mesh
