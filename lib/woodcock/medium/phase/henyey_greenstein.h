// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/error.h"
#include "woodcock/medium/phase/turn.h"

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

/// A turn in proportion to the phase function, by u in [0, 1). The inverted CDF is expanded in s =
/// 2u-1 so that g may be zero or of any small size, and 1 - cos and 1 + cos are computed separately
/// so that g may come close to +-1.
inline Turn turnOfHenyeyGreenstein(double u, double g) {
    const double s = 2 * u - 1;
    const double q = 1 + g * s;
    return {(1 - s) * (1 - g) * (1 - g) * (1 + g / 2 + g / 2 * s) / (q * q),
            (1 + s) * (1 + g) * (1 + g) * (1 - g / 2 + g / 2 * s) / (q * q)};
}

struct PhaseSample {
    Vec3d direction;  ///< the way the light path continues, unit length
    double pdf;       ///< per steradian
};

/// Samples a direction around unit vector `forward` in proportion to the phase function, by u in
/// [0,1)^2.
inline PhaseSample sampleHenyeyGreenstein(Vec3d forward, double g, double u0, double u1) {
    const double q = 1 + g * (2 * u0 - 1), width = (1 - g) * (1 + g);
    return {turned(forward, turnOfHenyeyGreenstein(u0, g), u1),
            q * q * q / (4 * pi * width * width)};
}

/// The kind of phase function that is Henyey and Greenstein's. With g 0 it is isotropic.
class HenyeyGreenstein {
public:
    static constexpr const char* name = "henyey_greenstein";

    /// Throws Error{Input} where g does not lie strictly between -1 and 1.
    explicit HenyeyGreenstein(double g) : g_(g) {
        if (!(std::abs(g) < 1))
            throw inputError("g is {}; it must lie strictly between -1 and 1", g);
    }
    double g() const { return g_; }
    double value(double cosine) const { return henyeyGreenstein(cosine, g_); }
    Turn sample(double u) const { return turnOfHenyeyGreenstein(u, g_); }
    double meanCosine() const { return g_; }

private:
    double g_;
};

}  // namespace woodcock::medium
