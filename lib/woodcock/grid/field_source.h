// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/vec.h"

namespace woodcock::grid {

/// How a field stores its voxels. Auto is half where that keeps every value exactly (as of grids
/// that were saved as half), else float. Fixed16 and Fixed8 are integers of so many bits between
/// the smallest and the largest value of a brick and channel: see FixedScale.
enum class Storage { Auto, Half, Float, Fixed16, Fixed8 };
/// Their names in scene files and options, in the same order.
inline const std::array<std::string, 5> storageNames{"auto", "half", "float", "fixed16", "fixed8"};
inline const std::string& storageName(Storage storage) {
    return storageNames[static_cast<std::size_t>(storage)];
}

/// How a field is read between its voxels.
enum class Lookup {
    Trilinear,  ///< the definition of a medium
    Nearest     ///< biased: the voxel nearest to the point
};

/// A constant cube of voxels: `size` (8, 128 or 4096) voxels wide, at a multiple of its size.
struct FieldTile {
    Vec3i origin;
    int size = 8;
    std::array<float, 3> value{};
};

/// A sparse grid, independent of the library that holds it: leaves of 8x8x8 voxels and constant
/// tiles, in index space; `background` everywhere else. Scalars use the first of three channels.
struct FieldSource {
    int channels = 1;  ///< 1 or 3
    std::array<float, 3> background{};
    std::vector<Vec3i> leafOrigins;  ///< multiples of 8
    std::vector<FieldTile> tiles;    ///< overlapping neither each other nor a leaf
    /// The field is 0 beyond these voxels and the one voxel around them that interpolation reaches,
    /// whatever the background. Absent: the background has no end.
    std::optional<Box3i> within = {};
    /// Writes the 512 x channels values of leaf `i`: x slowest, z fastest, channels innermost.
    /// Called from many threads.
    std::function<void(size_t i, std::span<float> values)> copyLeaf;
};

}  // namespace woodcock::grid
