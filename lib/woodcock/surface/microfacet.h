// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "woodcock/base/vec.h"

namespace woodcock::surface {

/// Facets of the GGX distribution (Walter et al. 2007, eq. 33), equally rough in all directions,
/// with Smith's masking. Vectors are of unit length in a frame whose z is the surface's normal;
/// `out` lies above it. Every formula is written so that it does not divide by small numbers at
/// grazing directions.
class Ggx {
public:
    explicit Ggx(double alpha) : alpha_(alpha) {}

    /// The normal of a facet, drawn among those that are visible from `out`, by u in [0, 1)^2.
    /// Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3.
    Vec3d sampleVisible(Vec3d out, double u0, double u1) const {
        const Vec3d o = normalize(Vec3d{alpha_ * out.x, alpha_ * out.y, out.z});
        const double whole = 1 + o.z, rest = (o.x * o.x + o.y * o.y) / whole;  // 1 +- o.z
        const double above = (1 - u1) * whole;  // of the cap's direction over -o.z
        const double sine = std::sqrt(u1 * whole * (above + rest));
        const double phi = 2 * pi * u0;
        return normalize(Vec3d{alpha_ * (o.x + sine * std::cos(phi)),
                               alpha_ * (o.y + sine * std::sin(phi)), above});
    }

    /// The density of that normal, per steradian of normals, over its cosine to `out`: G1(out)
    /// D(facet) / cos(out). Heitz 2014, eq. 16.
    double visible(Vec3d out, Vec3d facet) const {
        const double x = facet.x / alpha_, y = facet.y / alpha_;
        const double spread = x * x + y * y + facet.z * facet.z;
        const double d = 1 / (pi * alpha_ * alpha_ * spread * spread);
        return 2 * d / (out.z + slope(out));
    }

    /// The share of what is visible from `out` that is also visible from `in`: G2 / G1(out), for
    /// correlated heights (Heitz 2014, eq. 99). `in` may lie on the other side.
    double shadowing(Vec3d out, Vec3d in) const {
        const double o = slope(out), z = std::abs(in.z);
        return z * (out.z + o) / (z * o + out.z * slope(in));
    }

private:
    /// cos (1 + 2 Lambda), with Smith's Lambda (Heitz 2014, eq. 72).
    double slope(Vec3d v) const {
        return std::sqrt(v.z * v.z + alpha_ * alpha_ * (v.x * v.x + v.y * v.y));
    }

    double alpha_;
};

}  // namespace woodcock::surface
