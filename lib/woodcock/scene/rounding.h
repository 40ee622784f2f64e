// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "woodcock/base/vec.h"

namespace woodcock::scene {

// Numbers that people can read, where any near the exact one will do. Of scene/ only.

/// `v` to a multiple of 10^exponent.
inline double roundTo(double v, int exponent) {
    const double power = std::pow(10, std::abs(exponent));
    return exponent < 0 ? std::round(v * power) / power : std::round(v / power) * power;
}
inline Vec3d roundTo(Vec3d v, int exponent) {
    return {roundTo(v.x, exponent), roundTo(v.y, exponent), roundTo(v.z, exponent)};
}
inline int magnitude(double v) { return static_cast<int>(std::floor(std::log10(v))); }

}  // namespace woodcock::scene
