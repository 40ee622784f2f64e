// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/vec.h"

namespace woodcock::light {

/// A direction inside the cone of 1 - cos(half angle) = `oneMinusCos` around `axis`, uniform in
/// solid angle. 1 - cos is passed as such, so that tiny angles lose no digits.
inline Vec3d sampleCone(Vec3d axis, double oneMinusCos, double u0, double u1) {
    const double below = u0 * oneMinusCos;
    const double sine = std::sqrt(below * (2 - below)), phi = 2 * pi * u1;
    Vec3d s, t;
    orthonormalBasis(axis, s, t);
    return normalize(s * (sine * std::cos(phi)) + t * (sine * std::sin(phi)) + axis * (1 - below));
}

/// 1 - cos of the angle between unit vectors, exact for small angles.
inline double oneMinusCosine(Vec3d a, Vec3d b) { return dot(a - b, a - b) / 2; }

}  // namespace woodcock::light
