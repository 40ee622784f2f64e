// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/mesh/surface_mesh.h"

namespace woodcock {

/// The faces of a PLY file, cut into triangles, of the points as the file has them; with what is
/// known of its vertices' normals and texture coordinates. Errors: Input.
SurfaceMesh readPlyMesh(const std::filesystem::path& file);

}  // namespace woodcock
