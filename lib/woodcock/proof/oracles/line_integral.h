// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "woodcock/base/vec.h"

namespace woodcock::oracle {

/// A voxel's value; must be zero outside the box that goes with it.
using VoxelFunction = std::function<double(Vec3i)>;

/// Integral over t in [t0, t1] (t1 may be infinite) of the trilinear interpolation of `voxel` at
/// origin + direction t, in index space. Exact but for rounding: between all integer planes of all
/// axes the integrand is a cubic, where two-point Gauss-Legendre is exact. No cells, no bounds, no
/// skipping: every plane of `box` is visited.
double lineIntegral(const VoxelFunction& voxel, const Box3i& box, Vec3d origin, Vec3d direction,
                    double t0, double t1);

/// The trilinear interpolation itself.
double trilinear(const VoxelFunction& voxel, Vec3d at);

}  // namespace woodcock::oracle
