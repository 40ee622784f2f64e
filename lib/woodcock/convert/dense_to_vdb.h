// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "woodcock/base/vec.h"
#include "woodcock/convert/dense_volume.h"
#include "woodcock/convert/value_remap.h"

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::convert {

/// A fog volume of the volume's name, with the same voxel indices. The background is zero. Voxels
/// that are zero after remapping, within the tolerance, are inactive and take no memory. Values are
/// floats where these hold the samples' type exactly, else doubles; vectors for three channels.
/// Leaves are made in parallel. Errors: Input for a number of channels other than 1 or 3, and for
/// values that are not finite (see requireSound(), which the caller does for the sake of its note).
grid::VdbGrids denseToVdb(const DenseVolume& volume, const ValueOptions& options,
                          ValueSummary& summary, const WorkProgress& progress = {});

/// The voxels of `box` (or of the active ones' bounding box) of grid `i`, background included, x
/// fastest; floats or doubles as in the grid. Errors: Input for a grid without active voxels, and
/// where the box takes more than the machine's memory.
DenseVolume vdbToDense(const grid::VdbGrids& grids, std::size_t i,
                       const std::optional<Box3i>& box = {});

/// Remaps the active values of grids; inactive values and the background stay. Active voxels that
/// become zero become inactive where the background is zero.
void remapGrids(grid::VdbGrids& grids, const ValueOptions& options, ValueSummary& summary);

/// Converts every grid to floats, doubles, or vectors of these, the first type that holds all
/// values: integers become doubles, booleans and masks floats. Returns the largest change of a
/// value: more than zero only for integers beyond 2^53.
double useFloatingPoint(grid::VdbGrids& grids);

enum class Precision { Source, Half, Float, Double };

/// The largest changes of active values by a lower precision.
struct PrecisionLoss {
    double absolute = 0, relative = 0;
};

/// Turns grids to floats or doubles; for Half, to floats that are to be written as halves. Errors:
/// Input where values lie beyond the range.
PrecisionLoss setPrecision(grid::VdbGrids& grids, Precision precision);

}  // namespace woodcock::convert
