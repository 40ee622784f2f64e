// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "woodcock/base/toml_reader.h"
#include "woodcock/base/vec.h"
#include "woodcock/grid/field_source.h"

namespace woodcock {

// Values that several sections of a scene file share. Of scene/ only; all throw Error{Input}.

inline constexpr NumberRange zeroToOne{0, 1};

/// The mean cosine of a phase function.
float parseG(const TomlValue& value);

/// One of storageNames.
Storage parseStorage(const TomlValue& value);

/// { min = [x, y, z], max = [x, y, z] }
Box3d parseBounds(const TomlValue& value);

/// Throws where a table says both sigma_a or sigma_s, and scale or albedo.
void checkCoefficientKeys(const TomlTable& table);
/// Constant sigma_a and sigma_s, given as such or as scale and albedo; 0 where neither is.
std::pair<Rgb, Rgb> parseCoefficients(const TomlTable& table);

/// Scaled, then turned about x, y and z in this order (degrees), then moved.
Affine3d placement(Vec3d translate, Vec3d rotate, Vec3d scale);
/// The same of { translate, rotate, scale }; `what` is placed by it ("volume").
Affine3d parseTransform(const TomlValue& value, std::string_view what);
/// The table's `transform` or `matrix`; the identity where it has neither.
Affine3d parsePlacement(const TomlTable& table, std::string_view what);

}  // namespace woodcock
