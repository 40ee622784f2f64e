// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/level_set_to_fog.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/convert/openvdb_fog.h"
#include "woodcock/grid/vdb/openvdb_exact_copy.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::convert {

namespace {

template <class GridT>
openvdb::GridBase::Ptr convert(const openvdb::GridBase& source, const LevelSetToFogOptions& options,
                               std::vector<std::string>& notes) {
    const auto grid = openvdb::gridPtrCast<GridT>(source.deepCopyGrid());
    grid->setTransform(grid::exactCopy(source.transform()));
    for (auto it = grid->cbeginValueAll(); it; ++it)
        if (std::isnan(*it))
            throw inputError("level set '{}' holds a NaN at [{}, {}, {}]", source.getName(),
                             it.getCoord().x(), it.getCoord().y(), it.getCoord().z());
    const auto known = static_cast<double>(grid->background());
    if (!(known > 0) || !std::isfinite(known))
        throw inputError("level set '{}' has a background of {}; expected a positive distance",
                         source.getName(), known);
    if (options.band > known)
        notes.push_back(
            fmt::format("level set '{}' holds distances up to {} only: its fog reaches full "
                        "density at that depth instead of {}",
                        source.getName(), known, options.band));
    distancesToFog(*grid, options.band > 0 ? std::min(options.band, known) : known);
    if (grid->empty()) throw inputError("level set '{}' encloses nothing", source.getName());
    grid->setName(options.name);
    return grid;
}

openvdb::GridBase::Ptr convertOne(const openvdb::GridBase& grid,
                                  const LevelSetToFogOptions& options,
                                  std::vector<std::string>& notes) {
    if (grid.getGridClass() != openvdb::GRID_LEVEL_SET)
        throw inputError("grid '{}' is not a level set: its class is '{}'", grid.getName(),
                         openvdb::GridBase::gridClassToString(grid.getGridClass()));
    if (grid.isType<openvdb::FloatGrid>()) return convert<openvdb::FloatGrid>(grid, options, notes);
    if (grid.isType<openvdb::DoubleGrid>())
        return convert<openvdb::DoubleGrid>(grid, options, notes);
    throw inputError("level set '{}' holds {}; expected float or double", grid.getName(),
                     grid.valueType());
}

}  // namespace

grid::VdbGrids levelSetToFog(const grid::VdbGrids& levelSets, const LevelSetToFogOptions& options,
                             std::vector<std::string>& notes) {
    if (!(options.band >= 0) || !std::isfinite(options.band))
        throw usageError("a band of {}; it must be positive", options.band);
    grid::VdbGrids fog;
    for (const openvdb::GridBase::Ptr& grid : levelSets.grids)
        fog.grids.push_back(convertOne(*grid, options, notes));
    return fog;
}

}  // namespace woodcock::convert
