// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/grid/vdb/file.h"

namespace woodcock::grid {

struct VdbGrids;

/// Whether readVdbGrids() can read the grid: any grid of numbers with an affine transform, level
/// sets too.
bool isReadable(const GridListing& grid);

/// The grids of these unique names, in this order, as OpenVDB has them: values, active states,
/// transform and metadata as in the file; halves become floats. As safe with damaged files as
/// loadGrid(). The values may be any numbers, also NaN. Errors: Input, naming file and grid.
VdbGrids readVdbGrids(const VdbFile& file, const std::vector<std::string>& uniqueNames);

}  // namespace woodcock::grid
