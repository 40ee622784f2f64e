// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/grid/field_source.h"
#include "woodcock/grid/voxel_scan.h"

namespace woodcock::grid {

/// One float for each point of a regular lattice.
struct LatticeValues {
    Vec3i size;                 ///< points along x, y and z, each at least 1
    std::vector<float> values;  ///< x fastest: point (x, y, z) is [x + size.x (y + size.y z)]
};

struct LatticeSource {
    FieldSource field;  ///< holds the lattice; point (0, 0, 0) is voxel (0, 0, 0), background 0
    VoxelScan voxels;   ///< of all values of the leaves that the lattice touches
};

/// The lattice as a source for buildField(), as a VDB grid of the same voxels would give it.
/// Throws Error{Usage} where `values` are not as many as `size` says.
LatticeSource latticeSource(std::shared_ptr<const LatticeValues> lattice);

}  // namespace woodcock::grid
