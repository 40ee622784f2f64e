// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/convert/formats/points.h"
#include "woodcock/grid/vdb/file.h"

namespace woodcock::convert {

/// Whether a grid holds points (OpenVDB's PointDataGrid) in place of values.
bool isPointGrid(const grid::GridListing& grid);

/// The points of such a grid, in world space, with their radii where it has an attribute pscale or
/// radius. The file is not trusted: sizes are checked against its length before memory is taken,
/// and it may hold at most four points for each of its bytes, and a million more. Errors: Input,
/// with the place; also for codecs and transforms that are not known.
PointCloud readPointGrid(const grid::VdbFile& file, const grid::GridListing& grid);

}  // namespace woodcock::convert
