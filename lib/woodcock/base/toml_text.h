// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "woodcock/base/affine.h"
#include "woodcock/base/spectrum.h"

namespace woodcock {

// Values as TOML writes them; reading them back gives the same bits.

std::string tomlText(std::string_view text);  ///< "quoted", with escapes
std::string tomlNumber(double v);             ///< shortest
std::string tomlVector(Vec3d v);              ///< [x, y, z]
std::string tomlColour(Rgb v);                ///< a number where grey, [r, g, b] otherwise
std::string tomlColour(Vec3d v);
std::string tomlMatrix(const Affine3d& m);  ///< four rows, on lines of their own

}  // namespace woodcock
