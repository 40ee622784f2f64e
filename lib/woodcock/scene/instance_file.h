// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "woodcock/base/affine.h"

namespace woodcock::scene {

/// The places where a surface stands, from a text file with a line for each: `x y z`; `x y z
/// scale`; `x y z scale rx ry rz` (degrees, about x, y and z in this order, after scaling); or the
/// 12 numbers of a matrix, its upper three rows one after the other. What follows a # is a comment.
/// Throws Error{Input} that names the file and the line.
std::vector<Affine3d> readInstanceFile(const std::filesystem::path& file);

}  // namespace woodcock::scene
