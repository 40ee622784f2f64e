// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "woodcock/base/spectrum.h"

namespace woodcock::surface {

/// What a plane boundary between two indices of refraction does to unpolarised light.
struct Refraction {
    double reflectance = 1;  ///< exactly 1 beyond the critical angle
    double cosine = 0;       ///< of the refracted ray to the normal's other side; 0 beyond it
};

/// `cosine` > 0: of the ray to the normal on its side. `eta`: the other side's index of refraction
/// over this side's. Fresnel 1823; the refracted cosine by Snell's law.
inline Refraction refraction(double cosine, double eta) {
    const double sine = (1 - cosine) * (1 + cosine) / (eta * eta);  // squared, on the other side
    if (!(sine < 1)) return {};
    const double other = std::sqrt(1 - sine);
    const double s = (cosine - eta * other) / (cosine + eta * other);
    const double p = (eta * cosine - other) / (eta * cosine + other);
    return {(s * s + p * p) / 2, other};
}

/// Reflectance of a metal with index eta + i k, relative to the index on the light's side. (a + i
/// b)^2 = (eta + i k)^2 - sin^2: Born and Wolf 1999, eq. 14.2 (6) and following.
inline double conductorReflectance(double cosine, double eta, double k) {
    const double c2 = cosine * cosine, s2 = std::max(0.0, (1 - cosine) * (1 + cosine));
    const double real = eta * eta - k * k - s2, size = std::hypot(real, 2 * eta * k);
    const double a = std::sqrt(std::max(0.0, (size + real) / 2));
    const double b2 = std::max(0.0, (size - real) / 2);
    const auto ratio = [](double above, double below) { return below > 0 ? above / below : 1; };
    const auto square = [](double v) { return v * v; };
    const double s = ratio(square(a - cosine) + b2, square(a + cosine) + b2);
    const double p =
        s * ratio(square(a * cosine - s2) + b2 * c2, square(a * cosine + s2) + b2 * c2);
    return (s + p) / 2;
}

/// Reflectance from that at normal incidence: Schlick 1994, eq. 15.
inline Rgb schlickReflectance(double cosine, Rgb normal) {
    const double m = 1 - std::min(1.0, cosine), m2 = m * m;
    const auto f = static_cast<float>(m2 * m2 * m);
    return normal + (Rgb(1.0f) - normal) * f;
}

}  // namespace woodcock::surface
