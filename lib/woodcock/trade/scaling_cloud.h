// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "woodcock/render/scene.h"
#include "woodcock/trade/timing.h"

namespace woodcock::trade {

/// A cumulus, baked at some resolution, and the cost of loading it.
struct ScalingCloud {
    int side = 0;  ///< voxels along its longest side
    double boxVoxels = 0;
    std::uint64_t activeVoxels = 0;
    std::shared_ptr<const grid::Field> field;
    Affine3d worldFromIndex;
    /// Mean along the camera's rays of its views, where sigma_t is 1 times the density.
    double unitDepth = 0;
    double bakeSeconds = 0;
    Measured load, peer;  ///< wall clock, from the file: to our field, and by OpenVDB's own reading
    std::uint64_t fieldBytes = 0, majorantBytes = 0, peerBytes = 0;  ///< majorants: at depth 10
};

/// Bakes the preset `cumulus` through a file in `directory`, which is loaded `loads` times,
/// alternately by us and by OpenVDB, and then removed.
ScalingCloud bakeScalingCloud(int side, const std::filesystem::path& directory, int loads);

/// A variation of a picture of the cloud, under a sun and a sky.
struct ScalingView {
    double opticalDepth = 10;  ///< mean over the picture, by exact integration
    double albedo = 0.9, g = 0.6;
    int majorantSmallestLog2 = 1;
    /// This many volumes. Either they overlap and share the optical depth; or one is in the
    /// picture, and the others, of the same depth, are a hundred sizes away, where hardly any light
    /// arrives.
    int volumes = 1;
    bool apart = false;
};

render::Scene scalingScene(const ScalingCloud& cloud, const ScalingView& view);

/// Mean optical depth along the camera's rays through the first part, by exact integration.
double meanOpticalDepth(const render::Scene& scene);

}  // namespace woodcock::trade
