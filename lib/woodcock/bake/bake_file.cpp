// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/bake_file.h"

#include <fmt/ranges.h>
#include <openvdb/tools/MultiResGrid.h>

#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/grid/grid_info.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::bake {

namespace {

template <class Grid>
openvdb::GridBase::Ptr coarsened(const Grid& grid, int level) {
    openvdb::tools::MultiResGrid<typename Grid::TreeType> pyramid(
        static_cast<std::size_t>(level) + 1, grid);
    const typename Grid::Ptr coarse = pyramid.grid(static_cast<std::size_t>(level));
    coarse->setName(grid.getName());
    coarse->setGridClass(grid.getGridClass());
    return coarse;
}

openvdb::GridBase::Ptr coarsened(const openvdb::GridBase& grid, int level) {
    if (const auto* scalars = dynamic_cast<const openvdb::FloatGrid*>(&grid))
        return coarsened(*scalars, level);
    return coarsened(dynamic_cast<const openvdb::Vec3SGrid&>(grid), level);
}

}  // namespace

std::vector<std::filesystem::path> bakedFiles(const std::filesystem::path& file, int levels) {
    std::vector<std::filesystem::path> files{file};
    for (int level = 1; level <= levels; ++level)
        files.push_back(file.parent_path() /
                        fmt::format("{}.lod{}.vdb", file.stem().string(), level));
    return files;
}

std::vector<std::filesystem::path> writeBake(const std::filesystem::path& file, const Bake& bake,
                                             const grid::VdbWriteOptions& options, int levels) {
    const std::vector<std::filesystem::path> files = bakedFiles(file, levels);
    grid::writeVdb(file, *bake.grids, options);
    for (int level = 1; level <= levels; ++level) {
        grid::VdbGrids coarse;
        for (const auto& grid : bake.grids->grids) coarse.grids.push_back(coarsened(*grid, level));
        grid::writeVdb(files[static_cast<std::size_t>(level)], coarse, options);
    }
    return files;
}

grid::VdbCompression compressionNamed(std::string_view name) {
    if (name == "none") return grid::VdbCompression::None;
    return name == "zip" ? grid::VdbCompression::Zip : grid::VdbCompression::Blosc;
}

Affine3d transformOf(const std::filesystem::path& file, const std::string& grid) {
    const grid::VdbFile listed = grid::listGrids(file);
    const auto of = [&](const grid::GridListing& listing) {
        if (!listing.worldFromIndex)
            throw inputError("{}: grid '{}' has a transform that is not affine", file.string(),
                             listing.uniqueName);
        return *listing.worldFromIndex;
    };
    if (!grid.empty()) return of(grid::findGrid(listed, grid).grid);
    for (const grid::GridListing& listing : listed.grids)
        if (listing.usable()) return of(listing);
    throw inputError("{} has no grid of numbers to start from; it has: {}", file.string(),
                     grid::describeGrids(listed));
}

RecipeText recipeOfGrids(const std::filesystem::path& file) {
    const grid::VdbFile listed = grid::listGrids(file);
    Box3d bounds;
    std::string outputs;
    for (const grid::GridListing& listing : listed.grids) {
        if (!listing.usable()) continue;
        const grid::GridInfo info = grid::inspectGrid(listed, listing);
        if (!info.contents) throw inputError("{}", info.error);
        if (info.contents->worldBounds) bounds.add(*info.contents->worldBounds);
        outputs += fmt::format(
            "[[output]]\nname = {}\nnode = {{ type = \"grid\", file = {}, grid = {} }}\n",
            tomlText(listing.uniqueName), tomlText(std::filesystem::absolute(file).string()),
            tomlText(listing.uniqueName));
    }
    if (bounds.empty())
        throw inputError("{} has no grid of voxels to sample; it has: {}", file.string(),
                         grid::describeGrids(listed));
    return {fmt::format("about = {}\n[bounds]\nmin = {}\nmax = {}\n{}",
                        tomlText("the grids of " + file.string()), tomlVector(bounds.lower),
                        tomlVector(bounds.upper), outputs),
            file.string(), ""};
}

}  // namespace woodcock::bake
