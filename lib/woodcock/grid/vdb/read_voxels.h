// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/grid/field_source.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/voxel_scan.h"

namespace woodcock::grid {

/// Statistics of a grid's voxels.
struct GridStatistics {
    VoxelScan voxels;
    std::size_t activeTiles = 0, leaves = 0;
    Box3i activeBounds;  ///< of active voxels and tiles, index space
    std::array<float, 3> background{};
    std::size_t openVdbBytes = 0;  ///< memory of the tree in OpenVDB
};

/// Values that are set to zero while reading: NaN and infinite ones (`faulty`), and negative ones.
struct Repair {
    bool faulty = false;
    bool negative = false;
};

/// The grid as a source for buildField(); holds OpenVDB's tree as long as it lives.
struct GridSource {
    FieldSource field;          ///< constant leaves are tiles; those of the background are left out
    GridStatistics statistics;  ///< of the values before any repair
};

/// Reads the voxels of one grid (channels > 0), in parallel. Errors: Input when the file cannot be
/// read.
GridSource readGridSource(const VdbFile& listed, const GridListing& grid, Repair repair);

/// What OpenVDB itself makes of a grid, to measure loading against.
struct VdbPeer {
    std::uint64_t activeVoxels = 0;
    std::uint64_t bytes = 0;  ///< of its tree
};

/// Reads a grid by OpenVDB's own file class, all of it at once. It trusts the file: use it only for
/// files that this program has written. Throws Error{Input}.
VdbPeer readByOpenVdb(const std::filesystem::path& file, const std::string& grid);

}  // namespace woodcock::grid
