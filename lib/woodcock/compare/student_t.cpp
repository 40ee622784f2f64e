// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/student_t.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace woodcock::compare {

namespace {

/// The continued fraction of the incomplete beta function (Abramowitz and Stegun 26.5.8), by
/// Lentz's method.
double betaFraction(double a, double b, double x) {
    constexpr double tiny = 1e-300, enough = 1e-15;
    const auto kept = [](double v) { return std::abs(v) < tiny ? tiny : v; };
    double c = 1, d = 1 / kept(1 - (a + b) * x / (a + 1)), f = d;
    for (int m = 1; m < 10000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / kept(1 + even * d), c = kept(1 + even / c), f *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / kept(1 + odd * d), c = kept(1 + odd / c), f *= d * c;
        if (std::abs(d * c - 1) < enough) break;
    }
    return f;
}

/// log(gamma(a + 1/2) / gamma(a)); where a is large, without the cancellation of its parts.
double logGammaStep(double a) {
    if (a < 50) return std::lgamma(a + 0.5) - std::lgamma(a);
    return 0.5 * std::log(a) - 1 / (8 * a) + 1 / (192 * a * a * a);
}

/// Regularised incomplete beta function I_x(a, 1/2); `y` is 1 - x, without loss of digits.
double incompleteBeta(double a, double x, double y) {
    if (x <= 0) return 0;
    if (y <= 0) return 1;
    const double logX = y < 0.5 ? std::log1p(-y) : std::log(x);
    const double front = std::exp(logGammaStep(a) + a * logX) * std::sqrt(y / std::numbers::pi);
    if (x < (a + 1) / (a + 2.5)) return front * betaFraction(a, 0.5, x) / a;
    return 1 - front * betaFraction(0.5, a, y) / 0.5;
}

}  // namespace

double studentTwoSided(double t, double degrees) {
    if (std::isnan(t) || std::isnan(degrees)) return std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(t)) return 0;
    if (std::isinf(degrees)) return std::erfc(std::abs(t) / std::numbers::sqrt2);
    const double square = t * t;
    // Wallace 1959, "Bounds on normal approximations": the deviate of about the same chance.
    if (degrees > 1e6)
        return std::erfc(std::sqrt(degrees * std::log1p(square / degrees) / 2) *
                         (1 - 2 / (8 * degrees + 3)));
    return incompleteBeta(degrees / 2, degrees / (degrees + square), square / (degrees + square));
}

}  // namespace woodcock::compare
