// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/proof/oracles/line_integral.h"

namespace woodcock::oracle {

/// A scalar grid as OpenVDB itself looks it up, sparse ones and backgrounds included: none of our
/// code. Values that no medium can have (negative, NaN, infinite) are zero.
struct VdbVoxels {
    VoxelFunction at;  ///< of any voxel; for one thread at a time
    double background = 0;
    Box3i box;  ///< of all voxels that differ from the background
    Affine3d worldFromIndex;
    std::vector<Vec3d> matter;  ///< positions (index space) drawn in proportion to the values
};

/// Throws std::runtime_error where the grid is missing or not of numbers.
VdbVoxels readVoxels(const std::filesystem::path& file, const std::string& grid, int matterCount,
                     std::uint64_t seed);

}  // namespace woodcock::oracle
