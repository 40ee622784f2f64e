// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock {

/// A mesh of which it can be said what is inside: closed parts, each of triangles that face one
/// way, all outwards of the part or all inwards.
struct ClosedMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> partOf;  ///< of each triangle
    std::vector<double> volumes;        ///< of each part; negative where it faces inwards
    std::vector<std::string> notes;     ///< what was mended
};

/// Takes a welded mesh apart. What can be mended without a doubt is, and noted: triangles that are
/// there twice, single ones that face the wrong way, points that differ by rounding along open
/// edges. Errors: Input, saying where, for open edges, for edges that an odd number of triangles
/// share, and where triangles cannot all face one way; then no place is inside.
ClosedMesh closedMesh(const TriangleMesh& mesh);

}  // namespace woodcock
