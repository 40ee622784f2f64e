// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/mesh/triangle_mesh.h"

namespace woodcock {

/// The faces of a PLY file, cut into triangles; points of one place are one. Errors: Input.
TriangleMesh readPlyMesh(const std::filesystem::path& file);

}  // namespace woodcock
