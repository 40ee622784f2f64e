// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/grid/field.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/read_voxels.h"

namespace woodcock {

/// What a grid is loaded as. A colour may come from a scalar grid, as grey: its field has one
/// channel then.
enum class GridUse { Scalar, Colour };

/// What a grid means outside of its active voxels' box (and of the one voxel around it that
/// interpolation reaches), where its background is not 0: that background, or nothing, as for
/// media in pbrt-v4 and Cycles. A grid without active voxels is nothing then.
enum class GridReach { Everywhere, ActiveVoxels };

struct LoadOptions {
    GridUse use = GridUse::Scalar;
    GridReach reach = GridReach::Everywhere;
    Storage storage = Storage::Auto;
    bool nonNegative =
        true;             ///< a coefficient: values below zero are faults, as NaN and infinity are
    bool repair = false;  ///< faults become zero, and a note, instead of an error
    /// Makes other voxels of those that were found sound; null: they stay.
    std::function<FieldSource(FieldSource)> convert = {};
};

struct LoadedGrid {
    Field field;
    Affine3d worldFromIndex;
    GridStatistics statistics;       ///< of the values as they stand in the file
    std::vector<std::string> notes;  ///< what a user should know: repairs, unusual classes
    bool empty = false;              ///< it has no active voxels, which is noted
};

/// Loads a grid of a listed file. Errors: Input when the grid is of a kind that cannot be rendered,
/// of the wrong use, or holds faulty values; naming file and grid.
LoadedGrid loadGrid(const VdbFile& file, const GridListing& grid, const LoadOptions& options);

/// The same, from the names of a file and a grid.
LoadedGrid loadGrid(const std::filesystem::path& path, std::string_view gridName,
                    const LoadOptions& options = {});

/// "3 NaN voxels (first at [1, 2, 3]), 1 negative voxel (first at [4, 0, 0])"; empty for none.
std::string describeFaults(const GridStatistics& statistics, bool nonNegative);

}  // namespace woodcock
