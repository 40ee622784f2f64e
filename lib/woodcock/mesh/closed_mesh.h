// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::mesh {

/// A mesh with a well-defined inside: closed parts, each of whose triangles all face outwards, or
/// all inwards.
struct ClosedMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> partOf;  ///< of each triangle
    std::vector<double> volumes;        ///< of each part; negative where it faces inwards
    std::vector<std::string> notes;     ///< what was repaired
};

/// Takes a welded mesh apart. Faults that can be repaired without doubt are repaired and noted:
/// duplicate triangles, single triangles that face the wrong way, points along open edges that
/// differ by rounding. Errors: Input, with the position, for open edges, for edges of an odd number
/// of triangles, and where triangles cannot all face one way; such a mesh has no inside.
ClosedMesh closedMesh(const TriangleMesh& mesh);

}  // namespace woodcock::mesh
