// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/ValueTransformer.h>

#include <algorithm>

namespace woodcock::convert {

/// Turns signed distances (world units) into fog: zero at the surface, one from a depth of `band`
/// on. Where no point is as deep, no voxel is one. (OpenVDB's own function would end the band at
/// the deepest voxel.) Distances beyond the grid's narrow band must not be less than `band`.
template <class GridT>
void distancesToFog(GridT& grid, double band) {
    using V = typename GridT::ValueType;
    const auto scale = static_cast<V>(-1 / band);
    openvdb::tools::foreach (grid.beginValueAll(), [=](const typename GridT::ValueAllIter& value) {
        const V density = std::min(*value * scale, V(1));
        const bool inside = density > 0;
        value.setValue(inside ? density : V(0));
        value.setActiveState(inside);
    });
    grid.tree().root().setBackground(V(0), false);
    grid.setGridClass(openvdb::GRID_FOG_VOLUME);
    openvdb::tools::prune(grid.tree());
}

/// Of the active values.
template <class GridT>
double largestValue(const GridT& grid) {
    double largest = 0;
    for (auto it = grid.cbeginValueOn(); it; ++it)
        largest = std::max(largest, static_cast<double>(*it));
    return largest;
}

}  // namespace woodcock::convert
