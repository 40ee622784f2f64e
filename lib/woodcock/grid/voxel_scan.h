// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "woodcock/base/vec.h"

namespace woodcock::grid {

/// How many voxels share a fault, and the lexicographically first of them (index space).
struct VoxelCount {
    std::uint64_t count = 0;
    Vec3i first{};

    void add(Vec3i at, std::uint64_t n = 1);
    void add(const VoxelCount& more);
};

/// The result of a pass over all values of a grid. A tile counts with all of its voxels. A vector
/// voxel counts once, whichever component is at fault.
struct VoxelScan {
    std::uint64_t active = 0;
    std::uint64_t inactiveValues = 0;  ///< inactive voxels that differ from the background
    std::uint64_t finite = 0;  ///< active voxels, over which `min`, `max` and `mean` are taken
    std::array<float, 3> min{}, max{};  ///< per channel; meaningful where finite > 0
    std::array<double, 3> sum{};
    VoxelCount nan, infinite, negative;  ///< active or not
    bool exactAsHalf = true;             ///< every value survives conversion to half

    VoxelScan() {
        min.fill(std::numeric_limits<float>::infinity());
        max.fill(-std::numeric_limits<float>::infinity());
    }
    double mean(int channel = 0) const {
        return finite ? sum[static_cast<std::size_t>(channel)] / static_cast<double>(finite) : 0;
    }
    void add(const VoxelScan& more);
};

/// How the 512 voxels of a leaf may be kept.
enum class LeafKind : std::uint8_t { Background, Constant, Varying };

/// Adds a leaf to `scan`: 512 x channels values, x slowest, channels innermost; bit n % 64 of word
/// n / 64 of `activeMask` belongs to voxel n.
LeafKind scanLeaf(std::span<const float> values, int channels,
                  std::span<const std::uint64_t, 8> activeMask, Vec3i origin,
                  const std::array<float, 3>& background, VoxelScan& scan);

/// Adds a tile of size^3 voxels.
void scanTile(const std::array<float, 3>& value, int channels, bool active, Vec3i origin, int size,
              const std::array<float, 3>& background, VoxelScan& scan);

/// Sets NaN and infinite values to zero; with `negativeToo`, also those below zero.
void repairValues(std::span<float> values, bool negativeToo);

}  // namespace woodcock::grid
