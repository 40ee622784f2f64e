// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "woodcock/base/vec.h"

namespace woodcock::medium {

/// By how much light turns where it scatters. Both numbers keep their digits where the cosine of
/// the angle loses them, close to straight on and to straight back.
struct Turn {
    double below;  ///< 1 - cosine, in [0, 2]
    double above;  ///< 1 + cosine

    double cosine() const { return below < above ? 1 - below : above - 1; }
    Turn reversed() const { return {above, below}; }
};

/// The direction at this turn from unit vector `forward`, by u in [0, 1) around it. Unit length.
inline Vec3d turned(Vec3d forward, const Turn& turn, double u) {
    const double sine = std::sqrt(std::max(0.0, turn.below * turn.above));
    const double phi = 2 * pi * u;
    Vec3d x, y;
    orthonormalBasis(forward, x, y);
    const Vec3d d =
        x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) + forward * turn.cosine();
    return d / std::sqrt(dot(d, d));
}

/// A turn by one of two phase functions: by `second` with probability `share`. One number u in
/// [0, 1) decides and then samples.
template <class First, class Second>
Turn turnByEither(double u, double share, const First& first, const Second& second) {
    return u < share ? second.sample(u / share) : first.sample((u - share) / (1 - share));
}

}  // namespace woodcock::medium
