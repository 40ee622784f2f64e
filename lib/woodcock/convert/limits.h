// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "woodcock/base/error.h"
#include "woodcock/base/vec.h"

namespace woodcock::convert {

inline void requireVoxel(double voxel) {
    if (!(voxel > 0) || !std::isfinite(voxel))
        throw usageError("a voxel size of {}; it must be positive", voxel);
}

/// Errors: Input where the indices of a box exceed those of OpenVDB.
inline void requireIndices(Vec3d lower, Vec3d upper, double voxel) {
    constexpr double most = 1 << 30;
    const Vec3d furthest = max(-lower, upper);
    const double index = std::max({furthest.x, furthest.y, furthest.z});
    if (!(index < most))
        throw inputError(
            "with voxels of {} it reaches index {:.3g}, beyond the largest index, {}; take voxels "
            "of at least {:.3g}",
            voxel, index, most, voxel * index / most);
}

/// Errors: Input where `voxels` (an estimate) are more than `most`. Voxels on surfaces and in
/// solids grow in number by the second to third power.
inline void requireVoxels(double voxels, double voxel, std::uint64_t most) {
    if (!(voxels > static_cast<double>(most))) return;
    throw inputError(
        "voxels of {} would be about {:.3g} in number; {} are allowed; take voxels of at least "
        "{:.3g}, or allow more",
        voxel, voxels, most, voxel * std::sqrt(voxels / static_cast<double>(most)));
}

}  // namespace woodcock::convert
