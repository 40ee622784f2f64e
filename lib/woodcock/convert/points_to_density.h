// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock {

struct VdbGrids;

struct PointCloud {
    std::vector<Vec3f> points;
    std::vector<float> radii;    ///< one for each point, or none
    std::vector<float> weights;  ///< one for each point, or none
};

/// The vertices of a PLY file, or the lines of a table (.csv, .txt, .xyz; comma, semicolon or space
/// between the columns; a first line of names, or columns x y z and perhaps radius and density).
/// Radii are called radius, pscale or width (a diameter), weights density, weight or value.
/// Errors: Input, with line and column of what is wrong.
PointCloud readPoints(const std::filesystem::path& file);

struct PointsToDensityOptions {
    double voxel = 0;   ///< world units
    double radius = 0;  ///< of points that have none of their own; 0: two voxels
    /// Off: the weight is the density at the point, where it is alone. On: it is the integral of
    /// the point's density.
    bool normalised = false;
    std::string name = "density";
    std::uint64_t mostVoxels = 500'000'000;
};

/// Sums a smooth bump for each point: weight x (1 - (distance / radius)^2)^3. Radii below 1.5
/// voxels are widened to that, with their integral kept; `notes` says of how many. The result does
/// not depend on the number of threads. Errors: Input.
VdbGrids pointsToDensity(const PointCloud& cloud, const PointsToDensityOptions& options,
                         std::vector<std::string>& notes);

}  // namespace woodcock
