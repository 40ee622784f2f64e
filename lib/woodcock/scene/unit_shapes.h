// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/mesh/surface_mesh.h"

namespace woodcock::scene {

// The round shapes as meshes of as exact an area, for what has to be made of triangles: light.

/// The unit sphere in `rings` bands from pole to pole and twice as many sectors, with smooth
/// normals, u along the longitude and v from below. Scaled about its centre so that its area is 4
/// pi; with 48 rings no point is off by more than 1e-3.
mesh::SurfaceMesh sphereMesh(int rings);

/// The unit disk in y = 0 that faces +y, of area pi, as a fan of `sectors` triangles; u and v run
/// over the square around it as on rectangleMesh().
mesh::SurfaceMesh diskMesh(int sectors);

}  // namespace woodcock::scene
