// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/grid/field.h"

namespace woodcock::grid {

/// The i-th of the 8 corners of a unit cube, x first.
inline Vec3i sideOf(int i) { return {i & 1, i >> 1 & 1, i >> 2}; }

/// Exact bounds of the reconstruction, over all channels, in the closed cube of the block whose
/// first voxel is 8 `block`: the range of its own voxels and of the layer beyond its + faces that
/// interpolation reads.
Range blockRange(const Field& field, Vec3i block);

/// The bounds of all blocks, found in parallel. Blocks inside one constant region or tile of a
/// sparse table share one range. Where such a region borders on other values, its blocks have
/// entries of their own; where that would be very many, they share one looser range that covers
/// all.
BlockTable<Range> blockRanges(const Field& field);

}  // namespace woodcock::grid
