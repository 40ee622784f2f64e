// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "woodcock/grid/vdb/file.h"

namespace woodcock::grid {

/// The use of a grid, by its name, as Houdini, Blender and EmberGen name grids.
enum class GridRole { Density, Emission, Temperature, Colour, Velocity };

const char* roleName(GridRole role);

struct FoundGrid {
    GridListing grid;
    std::string note;  ///< which grid was chosen among several; empty when the name was exact
};

/// The grid of this name: exact, `name[2]`, or in another case. Errors: Input, listing what the
/// file holds and the nearest name.
FoundGrid findGrid(const VdbFile& file, std::string_view name);

/// The grid of this role, by the usual names in any case. A file's only scalar grid is its density,
/// whatever its name, unless that name is known to mean something else. Errors: Input, listing what
/// the file holds.
FoundGrid findGrid(const VdbFile& file, GridRole role);

/// The grids that hold a volume's velocities: one of vectors, or three with a component each.
using VelocityGrids = std::vector<GridListing>;

/// Those of this name: a vector grid, or the name before the endings of three scalar ones (".x",
/// "_x", "x", in any case), or the first of these. Errors: Input, where there is no such grid,
/// where it is of another kind, or where one of three is missing.
VelocityGrids findVelocities(const VdbFile& file, std::string_view name);
/// Those of the usual names, or of staggered vectors; empty: there are none.
VelocityGrids findVelocities(const VdbFile& file);

/// Whether the grid's name is one of the role's usual names, in any case.
bool isNamedFor(const GridListing& grid, GridRole role);

/// Whether a grid holds velocities, or a component of them, by its name or its staggered voxels.
bool meansVelocity(const GridListing& grid);

/// True when some grid of the file has one of the role's names.
bool hasRole(const VdbFile& file, GridRole role);

}  // namespace woodcock::grid
