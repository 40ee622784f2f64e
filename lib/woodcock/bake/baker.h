// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/bake/recipe.h"
#include "woodcock/base/affine.h"

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::bake {

struct BakeSettings {
    Affine3d worldFromIndex;  ///< of the grids that are made: voxels sit at integer positions
    /// The bake is refused if more voxels than this would be evaluated.
    double mostVoxels = 4e9;
    int threads = 0;  ///< 0: all; the result does not depend on it
};

/// Voxels of `size` world units, one of them at the origin.
BakeSettings cubicVoxels(double size);

struct BakedGridStatistics {
    std::string name;
    std::uint64_t activeVoxels = 0, leaves = 0, tiles = 0;
    std::uint64_t bytes = 0;  ///< of the tree in memory
    /// Active voxels next to the recipe's bounds, on its six sides: -x +x -y +y -z +z.
    std::array<std::uint64_t, 6> atBounds{};
    double least = 0, greatest = 0;  ///< of the active values, over all channels
};

struct Bake {
    std::shared_ptr<grid::VdbGrids> grids;
    std::vector<BakedGridStatistics> statistics{};  ///< of each grid
    double boxVoxels = 0;                           ///< within the recipe's bounds
    std::uint64_t evaluatedVoxels = 0;              ///< those of nodes that need grids included
    double seconds = 0;                             ///< for all of them
};

/// Called now and then with the progress, 0 to 1, by one thread at a time. Returning false ends the
/// bake.
using BakeProgress = std::function<bool(double done)>;

/// Evaluates a recipe, leaf by leaf, and only where the bounds of its nodes allow values other than
/// zero. Absent where `progress` ended it. Errors: Input, when there are too many voxels, when all
/// grids are empty, and for values that are not finite (with their number and the position of the
/// first).
std::optional<Bake> bakeRecipe(const Recipe& recipe, const BakeSettings& settings,
                               const BakeProgress& progress = {});

/// The values of an output at world positions, evaluated densely. bakeRecipe() must agree with
/// them.
std::vector<Vec3d> evaluateRecipe(const Recipe& recipe, std::size_t output,
                                  const std::vector<Vec3d>& positions);

}  // namespace woodcock::bake
