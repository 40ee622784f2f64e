// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/affine.h"
#include "woodcock/grid/field.h"

namespace woodcock::grid {

/// The field at half its resolution: each voxel is the mean of eight, so the integral of the values
/// above the background stays the same. Voxels are stored as floats; the lookup stays as it is.
///
/// With `weights`, a field in the same index space, it is the mean weighted by their first channel,
/// where any weight is positive.
Field coarsened(const Field& field, const Field* weights = nullptr);

/// The map to a field's index space from that of coarsened(): a coarse voxel is in the middle of
/// its eight.
inline Affine3d fineFromCoarse() {
    return Affine3d::translate({0.5, 0.5, 0.5}) * Affine3d::scale({2, 2, 2});
}

}  // namespace woodcock::grid
