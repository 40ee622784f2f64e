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

namespace woodcock::grid {

/// What a grid is loaded as. A scalar grid can be loaded as a colour: it is grey, and its field has
/// one channel.
enum class GridUse { Scalar, Colour };

/// The extent of a grid whose background is not 0. Outside of the box of its active voxels, and of
/// the one voxel around it that interpolation reaches, it has that background (Everywhere), or it
/// is 0 (ActiveVoxels), as media in pbrt-v4 and Cycles are. Then a grid without active voxels is
/// empty.
enum class GridReach { Everywhere, ActiveVoxels };

struct LoadOptions {
    GridUse use = GridUse::Scalar;
    GridReach reach = GridReach::Everywhere;
    Storage storage = Storage::Auto;
    bool nonNegative =
        true;              ///< for a coefficient: negative values are faults, like NaN and infinity
    bool repair = false;   ///< faults are set to zero, with a note, instead of an error
    bool onFaces = false;  ///< the caller knows where a staggered grid's values belong
    /// Converts the voxels, once they were found sound; null: they stay.
    std::function<FieldSource(FieldSource)> convert = {};
};

struct LoadedGrid {
    Field field;
    Affine3d worldFromIndex;
    GridStatistics statistics;       ///< of the values as they stand in the file
    std::vector<std::string> notes;  ///< for the user: repairs, unusual classes
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

}  // namespace woodcock::grid
