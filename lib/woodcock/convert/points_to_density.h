// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock {

struct VdbGrids;

struct PointCloud {
    std::vector<Vec3d> points;
    std::vector<float> radii{};        ///< one for each point, or none
    std::vector<float> weights{};      ///< one for each point, or none
    std::string columns{};             ///< what the columns of a file were taken for, in words
    std::vector<std::string> notes{};  ///< what a user should know of how it was read
};

/// The vertices of a PLY file, or the lines of a table (.csv, .txt, .xyz): semicolons, tabs, commas
/// or spaces between the columns. A first line of names says what they are, also one behind # or
/// //; without it the first three are x, y and z, and no other is used. Radii are called radius,
/// pscale or width (a diameter), weights density, weight or value. `columns` names them, as
/// "x,y,z,radius"; then a first line of names does not count. Errors: Input, with line and column
/// of what is wrong; Usage for `columns` that are none.
PointCloud readPoints(const std::filesystem::path& file,
                      const std::optional<std::string>& columns = {});

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
