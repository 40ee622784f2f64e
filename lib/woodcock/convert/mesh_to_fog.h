// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::convert {

struct MeshToFogOptions {
    double voxel = 0;  ///< world units, as all lengths here
    double band = 0;   ///< the depth at which density reaches one; 0: three voxels
    /// Density around the surface instead of inside it: one at the surface, zero at `band` from it.
    /// Use it for meshes that enclose nothing.
    bool shell = false;
    std::string name = "density";
    std::uint64_t mostVoxels = 500'000'000;
};

/// Fog inside a mesh: zero at the surface, one from a depth of `band` on. Where no point is as
/// deep, no voxel is one. MeshInside decides what is inside: cavities stay empty, overlapping parts
/// are a union. `notes` tells what was repaired, what is thinner than voxels, and the largest
/// density where that is below one. Errors: Input, where the mesh has no inside, as an open one
/// (closedMesh()).
grid::VdbGrids meshToFog(const mesh::TriangleMesh& mesh, const MeshToFogOptions& options,
                         std::vector<std::string>& notes);

struct MeshToLevelSetOptions {
    double voxel = 0;
    double band = 0;  ///< world units: distances are right up to this, on both sides
    std::string name = "surface";
    std::uint64_t mostVoxels = 500'000'000;
};

/// Signed distance to a mesh in world units, negative inside; beyond the band plus or minus a
/// little more than the band. `notes` and errors as above.
grid::VdbGrids meshToLevelSet(const mesh::TriangleMesh& mesh, const MeshToLevelSetOptions& options,
                              std::vector<std::string>& notes);

}  // namespace woodcock::convert
