// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::mesh {

/// Cuts a polygon of three or more corners into triangles of the same winding, as indices of its
/// corners: by cutting off ears, which is right for reentrant corners too. A polygon of more than
/// 512 corners, or one that crosses itself, becomes a fan where no ear is found.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3d> corners);

}  // namespace woodcock::mesh
