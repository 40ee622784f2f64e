// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock {

/// Cuts a polygon of three or more corners into triangles of the same winding, as indices of its
/// corners: ears are cut off, so that reentrant corners are right too. Those of more than 512
/// corners, and those that cross themselves, become a fan where no ear is found.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3d> corners);

}  // namespace woodcock
