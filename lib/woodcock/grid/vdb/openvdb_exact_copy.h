// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/math/Maps.h>

#include "woodcock/grid/vdb/openvdb_transform.h"

namespace woodcock::grid {

/// A copy with every digit of the voxels' size. OpenVDB's own copy of a transform, and so of a
/// grid, finds that size as a difference of two points: far from the origin a size of 0.1 becomes
/// 0.09999999963.
inline openvdb::math::Transform::Ptr exactCopy(const openvdb::math::Transform& transform) {
    const openvdb::math::MapBase& map = *transform.baseMap();
    if (!map.isLinear() || dynamic_cast<const openvdb::math::AffineMap*>(&map))
        return transform.copy();
    return openVdbTransform(affineOf(map));
}

}  // namespace woodcock::grid
