// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock {

struct Medium;

// What a medium is at a point, as denoisers ask of surfaces.

/// sigma_s / sigma_t of the whole medium, in [0, 1]; 0 where there is none.
Rgb scatteringAlbedo(const Medium& medium, Vec3d world);

/// The way out, as a surface's normal is: unit vector down the gradient of sigma_t (mean of the
/// channels), from the reconstruction a voxel to either side. 0 where density is even, as in
/// homogeneous boxes, whose faces it does not know.
Vec3d densityNormal(const Medium& medium, Vec3d world);

}  // namespace woodcock
