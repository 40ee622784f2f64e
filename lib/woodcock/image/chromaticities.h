// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace woodcock::image {

/// CIE xy of red, green, blue and white, in this order, as OpenEXR stores them.
using Chromaticities = std::array<float, 8>;

/// The chromaticities of the linear colour space named `name` ("Linear Rec.709 (sRGB)", "ACES -
/// ACEScg", "lin_rec2020", "ACES2065-1"); absent where the name is not known.
std::optional<Chromaticities> chromaticitiesFromName(std::string_view name);

/// Their linear space as the Color Interop Forum names it: "lin_rec709_scene"; empty where it has
/// no name there.
std::string interopIdOf(const Chromaticities& chromaticities);

}  // namespace woodcock::image
