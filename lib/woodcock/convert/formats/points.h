// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock {

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

}  // namespace woodcock
