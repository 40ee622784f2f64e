// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/affine.h"
#include "woodcock/grid/field.h"

namespace woodcock {

/// The field at half its resolution: each voxel is the mean of eight, so the integral of what lies
/// above the background stays the same. Voxels are floats; the look-up stays what it is.
///
/// `weights`, a field in the same index space, makes it the weighted mean by its first channel
/// where any weight is positive.
Field coarsened(const Field& field, const Field* weights = nullptr);

/// Index space of a field from that of coarsened(): a voxel sits in the middle of its eight.
inline Affine3d fineFromCoarse() {
    return Affine3d::translate({0.5, 0.5, 0.5}) * Affine3d::scale({2, 2, 2});
}

}  // namespace woodcock
