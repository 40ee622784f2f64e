// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/ValueTransformer.h>

namespace woodcock {

/// Signed distances (world units) to fog: zero at the surface, one from `band` below it on, where
/// OpenVDB's own function goes a little beyond one.
template <class GridT>
void distancesToFog(GridT& grid, double band) {
    using V = typename GridT::ValueType;
    openvdb::tools::sdfToFogVolume(grid, static_cast<V>(band));
    openvdb::tools::foreach (grid.beginValueOn(), [](const typename GridT::ValueOnIter& value) {
        if (*value > V(1)) value.setValue(V(1));
    });
    openvdb::tools::prune(grid.tree());
}

}  // namespace woodcock
