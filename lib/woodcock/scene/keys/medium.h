// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {

// What volumes and the media of surfaces say alike.

/// sigma_a and sigma_s against scale and albedo.
std::vector<Exclusion> coefficientExclusions();

/// The sigma_a and sigma_s that a table's scale and albedo say; nothing where it has no scale.
/// Throws Error{Input} on an albedo without a scale.
std::optional<std::pair<Rgb, Rgb>> readScaleAndAlbedo(const TomlTable& table);

/// { min = [x, y, z], max = [x, y, z] }
Value<Box3d> bounds();

}  // namespace woodcock::scene
