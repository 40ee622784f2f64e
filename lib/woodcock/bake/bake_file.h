// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/bake/baker.h"
#include "woodcock/bake/recipe.h"
#include "woodcock/grid/vdb/write.h"

namespace woodcock::bake {

/// The files that writeBake() writes.
std::vector<std::filesystem::path> bakedFiles(const std::filesystem::path& file, int levels);

/// Writes the baked grids, and `levels` coarser versions beside them: smoke.vdb, smoke.lod1.vdb
/// with voxels twice as large, and so on. Coarsening is the full weighting of 27 voxels, as in
/// multigrid methods: a coarse voxel lies on every second fine one, and mass is kept. Returns the
/// files. Errors: Failure, as of writeVdb().
std::vector<std::filesystem::path> writeBake(const std::filesystem::path& file, const Bake& bake,
                                             const grid::VdbWriteOptions& options, int levels);

grid::VdbCompression compressionNamed(std::string_view name);  ///< "none", "zip" or "blosc"

/// The transform of a file's grid, the first one that has voxels if `grid` is empty. Errors: Input.
Affine3d transformOf(const std::filesystem::path& file, const std::string& grid);

/// The text of a recipe that copies the grids of a file: each is a `grid` node and an output.
/// Errors: Input.
RecipeText recipeOfGrids(const std::filesystem::path& file);

}  // namespace woodcock::bake
