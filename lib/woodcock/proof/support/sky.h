// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "woodcock/base/vec.h"

namespace woodcock::proof {

/// The direction of 1 - cos = `below` from unit vector `axis`, at `angle` around it; keeps the
/// digits of tiny angles.
inline Vec3d around(Vec3d axis, double below, double angle) {
    Vec3d s, t;
    orthonormalBasis(axis, s, t);
    const double sine = std::sqrt(below * (2 - below));
    return normalize(s * (sine * std::cos(angle)) + t * (sine * std::sin(angle)) +
                     axis * (1 - below));
}

/// 1 - cos of the angle between unit vectors, exact for tiny angles.
inline double below(Vec3d a, Vec3d b) { return dot(a - b, a - b) / 2; }

/// The angle of `d` around `axis` in [0, 1), as in around().
inline double turn(Vec3d axis, Vec3d d) {
    Vec3d s, t;
    orthonormalBasis(axis, s, t);
    const double a = std::atan2(dot(d, t), dot(d, s)) / (2 * pi);
    return a < 0 ? a + 1 : a;
}

}  // namespace woodcock::proof
