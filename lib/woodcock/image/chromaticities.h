// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace woodcock {

/// CIE xy of red, green, blue and white, in this order, as OpenEXR keeps them.
using Chromaticities = std::array<float, 8>;

/// Of the linear colour space that users call `name` ("Linear Rec.709 (sRGB)", "ACES - ACEScg",
/// "lin_rec2020", "ACES2065-1"); empty where the name tells nothing.
std::optional<Chromaticities> chromaticitiesFromName(std::string_view name);

}  // namespace woodcock
