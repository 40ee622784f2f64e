// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock::medium {

struct Medium;

// Albedo and normal of a medium at a point and a time within the shutter, as denoisers use those of
// surfaces.

/// sigma_s / sigma_t of the whole medium, in [0, 1]; 0 where there is none.
Rgb scatteringAlbedo(const Medium& medium, Vec3d world, float time = 0);

/// A normal that points out of the medium: the unit vector against the gradient of sigma_t (mean of
/// the channels), by differences over one voxel to either side (world). 0 where the density is
/// uniform, as in homogeneous boxes; their faces are not considered.
Vec3d densityNormal(const Medium& medium, Vec3d world, float time = 0);

}  // namespace woodcock::medium
