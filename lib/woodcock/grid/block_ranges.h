// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/grid/field.h"

namespace woodcock {

/// Exact bounds of the reconstruction, over all channels, in the closed cube of the block that
/// holds voxel `8 block`: of its own voxels and the one layer beyond its + faces that interpolation
/// reads.
Range blockRange(const Field& field, Vec3i block);

/// The same for all blocks, found in parallel. Blocks inside one constant region or tile of a
/// sparse table share one range; where such a region looks onto other values it has entries of its
/// own, or one hull where very many would be needed (looser there, never wrong).
BlockTable<Range> blockRanges(const Field& field);

}  // namespace woodcock
