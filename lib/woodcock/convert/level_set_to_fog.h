// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace woodcock {

struct VdbGrids;

struct LevelSetToFogOptions {
    double band = 0;  ///< the depth at which density reaches one, world units; 0: all that is known
    std::string name = "density";  ///< of the fog
};

/// Fog inside each level set of `levelSets`: zero at the surface, one from `band` below it on.
/// `notes` says where a grid knows distances up to less than the band, which then ends there.
/// Errors: Input, naming the grid, where it is no level set of float or double, holds a NaN or has
/// no inside.
VdbGrids levelSetToFog(const VdbGrids& levelSets, const LevelSetToFogOptions& options,
                       std::vector<std::string>& notes);

}  // namespace woodcock
