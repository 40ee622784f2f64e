// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/error.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/convert/point_grid_read.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"
#include "woodcock/grid/vdb/read_grids.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

namespace {

void turn(openvdb::GridBase& grid, const AxisOrder& axes, const Affine3d& worldFromIndex) {
    grid.setTransform(grid::openVdbTransform(axes.map() * worldFromIndex));
}

/// Names, turns and remaps the grids of a file, as the options say.
void finishGrids(Source& source, const fs::path& in, const ConvertOptions& options) {
    for (const openvdb::GridBase::Ptr& grid : source.grids.grids)
        if (!options.axes.identity())
            turn(*grid, options.axes, grid::affineOf(*grid->transform().baseMap()));
    if (options.name) {
        if (source.grids.grids.size() > 1)
            throw usageError("--name is for one grid, and {} has {}; choose one by --grid",
                             in.string(), source.grids.grids.size());
        source.grids.grids.front()->setName(*options.name);
    }
    ValueSummary found;
    if (!options.values.remap.identity() || options.values.tolerance > 0 || options.values.repair) {
        remapGrids(source.grids, options.values, found);
        say(options.warn, requireSound(found, in.string(), options.values.repair));
    }
}

void requireNoPlacement(const ConvertOptions& options) {
    const Placement& placement = options.placement;
    if (placement.any() || options.channel)
        throw usageError(
            "--voxel, --size, --origin and --channel are not for VDB files, which have a transform "
            "of their own");
}

bool holdsPoints(const grid::VdbFile& file, const grid::GridListing& grid) {
    return !file.nanoVdb && isPointGrid(grid);
}

/// The grid that --grid names, or all grids that hold numbers or points. A warning names each of
/// the others.
std::vector<grid::GridListing> chooseGrids(const grid::VdbFile& file,
                                           const ConvertOptions& options) {
    if (options.grid) {
        grid::FoundGrid found = grid::findGrid(file, *options.grid);
        say(options.warn, found.note);
        return {std::move(found.grid)};
    }
    std::vector<grid::GridListing> chosen;
    for (const grid::GridListing& grid : file.grids) {
        if (grid::isReadable(grid) || holdsPoints(file, grid))
            chosen.push_back(grid);
        else
            say(options.warn, fmt::format("grid '{}' of {} is left out: {}", grid.uniqueName,
                                          file.path.string(), grid.unusable));
    }
    if (chosen.empty())
        throw inputError("{} has no grid of numbers; it has: {}", file.path.string(),
                         grid::describeGrids(file));
    return chosen;
}

}  // namespace

Source readGridsSource(const fs::path& in, const ConvertOptions& options) {
    const grid::VdbFile file = grid::listGrids(in);
    say(options.warn, file.warning);
    std::vector<grid::GridListing> chosen, points;
    for (grid::GridListing& grid : chooseGrids(file, options))
        (holdsPoints(file, grid) ? points : chosen).push_back(std::move(grid));
    if (points.empty()) requireNoPlacement(options);
    std::vector<std::string> names;
    for (const grid::GridListing& grid : chosen) names.push_back(grid.uniqueName);
    Source source{grid::readVdbGrids(file, names), {}, names};
    fillLevelSets(source.grids, options);
    for (std::size_t i = 0; i < chosen.size(); ++i)
        say(options.info,
            fmt::format("read '{}' ({}) from {}: {} active voxels", names[i], chosen[i].valueType,
                        in.string(), source.grids.grids[i]->activeVoxelCount()));
    for (const grid::GridListing& grid : points)
        if (addPointGrid(source.grids, file, grid, options))
            source.uniqueNames.push_back(grid.uniqueName);
    if (source.grids.grids.empty())
        throw inputError("{} holds only grids of points, and these are empty", in.string());
    const double loss = useFloatingPoint(source.grids);
    if (loss > 0)
        say(options.warn,
            fmt::format("{}: integers beyond 2^53 become doubles; they change by {:.3g} at most",
                        in.string(), loss));
    finishGrids(source, in, options);
    return source;
}

}  // namespace woodcock::convert
