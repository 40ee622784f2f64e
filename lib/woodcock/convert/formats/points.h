// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::convert {

struct PointCloud {
    std::vector<Vec3d> points;
    std::vector<float> radii{};        ///< one for each point, or none
    std::vector<float> weights{};      ///< one for each point, or none
    std::string columns{};             ///< how the columns of a file were read, in words
    std::vector<std::string> notes{};  ///< for the user: what was assumed while reading
};

/// The vertices of a PLY file, or the lines of a table (.csv, .txt, .xyz): semicolons, tabs, commas
/// or spaces between the columns. A first line of names, also behind # or //, names the columns.
/// Without it the first three are x, y and z, and no other is used. Radii are called radius, pscale
/// or width (a diameter); weights are called density, weight or value. `columns` names the columns
/// instead, such as "x,y,z,radius"; then a first line of names is ignored. Errors: Input, with line
/// and column of the fault; Usage for wrong `columns`.
PointCloud readPoints(const std::filesystem::path& file,
                      const std::optional<std::string>& columns = {});

}  // namespace woodcock::convert
