// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::convert {

/// Numbers of a voxel, and their type.
template <class Value>
struct VoxelTraits {
    static constexpr int channels = openvdb::VecTraits<Value>::IsVec ? 3 : 1;
    using Number = typename openvdb::VecTraits<Value>::ElementType;
};

/// Calls `use(grid)` with the grid as its own type, among those of floating point. False for
/// others.
template <class Use>
bool withFloatingGrid(openvdb::GridBase& grid, Use use) {
    const auto tryAs = [&]<class GridT>(GridT*) {
        if (!grid.isType<GridT>()) return false;
        use(static_cast<GridT&>(grid));
        return true;
    };
    return tryAs(static_cast<openvdb::FloatGrid*>(nullptr)) ||
           tryAs(static_cast<openvdb::DoubleGrid*>(nullptr)) ||
           tryAs(static_cast<openvdb::Vec3SGrid*>(nullptr)) ||
           tryAs(static_cast<openvdb::Vec3DGrid*>(nullptr));
}

}  // namespace woodcock::convert
