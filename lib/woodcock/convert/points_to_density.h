// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "woodcock/convert/formats/points.h"

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::convert {

struct PointsToDensityOptions {
    double voxel = 0;   ///< world units
    double radius = 0;  ///< of points that have none of their own; 0: two voxels
    /// False: the weight is the density at the point, if no other is near. True: it is the integral
    /// of the point's density.
    bool normalised = false;
    std::string name = "density";
    std::uint64_t mostVoxels = 500'000'000;
};

/// Sums a smooth bump for each point: weight x (1 - (distance / radius)^2)^3. Radii below 1.5
/// voxels are widened to that, with their integral kept; `notes` tells how many. The result does
/// not depend on the number of threads. Errors: Input.
grid::VdbGrids pointsToDensity(const PointCloud& cloud, const PointsToDensityOptions& options,
                               std::vector<std::string>& notes);

}  // namespace woodcock::convert
