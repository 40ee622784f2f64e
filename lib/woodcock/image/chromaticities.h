// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace woodcock::image {

/// CIE xy of red, green, blue and white, in this order, as OpenEXR stores them.
using Chromaticities = std::array<float, 8>;

/// The chromaticities of the linear colour space named `name` ("Linear Rec.709 (sRGB)", "ACES -
/// ACEScg", "lin_rec2020", "ACES2065-1"); absent where the name is not known.
std::optional<Chromaticities> chromaticitiesFromName(std::string_view name);

}  // namespace woodcock::image
