// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "woodcock/base/vec.h"

namespace woodcock::medium {

/// Henyey-Greenstein with mean cosine g in (-1, 1): value per steradian for the cosine between the
/// way the light travelled before and after. Integrates to one over the sphere. Henyey and
/// Greenstein 1941, eq. 2; the denominator 1 + g^2 - 2 g cos is written without the cancellation
/// that would lose all digits near g = +-1.
inline double henyeyGreenstein(double cosine, double g) {
    const double d = g >= 0 ? (1 - g) * (1 - g) + 2 * g * (1 - cosine)
                            : (1 + g) * (1 + g) - 2 * g * (1 + cosine);
    return (1 - g) * (1 + g) / (4 * pi * d * std::sqrt(d));
}

struct PhaseSample {
    Vec3d direction;  ///< the way the light path continues, unit length
    double pdf;       ///< per steradian: the phase function itself
};

/// Samples a direction around unit vector `forward` in proportion to the phase function, by u in
/// [0,1)^2. The inverted CDF is expanded in s = 2u-1 so that g may be zero or of any small size,
/// and 1 - cos and 1 + cos are computed separately so that g may come close to +-1.
inline PhaseSample sampleHenyeyGreenstein(Vec3d forward, double g, double u0, double u1) {
    const double s = 2 * u0 - 1;
    const double q = 1 + g * s;
    const double below =
        (1 - s) * (1 - g) * (1 - g) * (1 + g / 2 + g / 2 * s) / (q * q);  // 1 - cos
    const double above =
        (1 + s) * (1 + g) * (1 + g) * (1 - g / 2 + g / 2 * s) / (q * q);  // 1 + cos
    const double cosine = below < above ? 1 - below : above - 1;
    const double sine = std::sqrt(std::max(0.0, below * above));
    const double phi = 2 * pi * u1;
    Vec3d x, y;
    orthonormalBasis(forward, x, y);
    const Vec3d d = x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) + forward * cosine;
    const double width = (1 - g) * (1 + g);
    return {d / std::sqrt(dot(d, d)), q * q * q / (4 * pi * width * width)};
}

}  // namespace woodcock::medium
