// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::convert {

struct LevelSetToFogOptions {
    double band = 0;  ///< the depth at which density reaches one, world units; 0: the narrow band's
    std::string name = "density";  ///< of the fog
};

/// Fog inside each level set of `levelSets`: zero at the surface, one from `band` below it on.
/// Where a grid's narrow band is smaller, it replaces `band`, and `notes` says so. Errors: Input,
/// naming the grid, where it is not a level set of float or double, holds a NaN, or encloses
/// nothing.
grid::VdbGrids levelSetToFog(const grid::VdbGrids& levelSets, const LevelSetToFogOptions& options,
                             std::vector<std::string>& notes);

}  // namespace woodcock::convert
