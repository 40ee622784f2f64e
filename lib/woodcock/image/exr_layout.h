// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace woodcock::image::exr {

// The two words that an OpenEXR file begins with ("OpenEXR File Layout"). The second one's lowest
// byte is the version, and flags are above it.
inline constexpr std::uint32_t magic = 20000630, version = 2, versionMask = 0xff;
inline constexpr std::uint32_t tiled = 0x200, longNames = 0x400, deepParts = 0x800,
                               severalParts = 0x1000;

}  // namespace woodcock::image::exr
