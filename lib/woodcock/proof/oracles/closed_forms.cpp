// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/closed_forms.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

namespace {

/// (1 - exp(-x)) / x, 1 at 0
double meanOfExp(double x) { return x == 0 ? 1 : -std::expm1(-x) / x; }

/// 1 + g^2 - 2 g cosine, without cancellation near the peak
double henyeyGreensteinDistance(double cosine, double g) {
    const double edge = 1 - std::abs(g);
    return edge * edge + 2 * (g > 0 ? g * (1 - cosine) : -g * (1 + cosine));
}

}  // namespace

double slabTransmittance(double opticalDepth, double mu) { return std::exp(-opticalDepth / mu); }

double emittedRadiance(double emission, double absorption, double length) {
    const double depth = absorption * length;
    return depth < 1 ? emission * length * meanOfExp(depth)
                     : emission / absorption * -std::expm1(-depth);
}

double sphereDiscTransmittance(double opticalRadius) {
    const double y = 2 * opticalRadius;  // 2 (1 - (1 + y) exp(-y)) / y^2
    if (y > 1) return 2 * (1 - (1 + y) * std::exp(-y)) / y / y;
    double sum = 0, term = 1;  // the sum of 2 (-y)^k / (k! (k + 2)), as the difference would cancel
    for (int k = 0; k < 20; ++k) {
        sum += 2 * term / (k + 2);
        term *= -y / (k + 1);
    }
    return sum;
}

double gaussianBallOpticalDepth(double sigma, double s, double offset) {
    const double b = offset / s;
    return std::sqrt(2 * pi) * sigma * s * std::exp(-b * b / 2);
}

double exponentialAtmosphereOpticalDepth(double sigma, double scaleHeight, double bottom,
                                         double top, double mu) {
    return sigma * std::exp(-bottom / scaleHeight) * scaleHeight / mu *
           -std::expm1(-(top - bottom) / scaleHeight);
}

double rampOpticalDepth(double sigmaStart, double sigmaEnd, double length) {
    return (sigmaStart + sigmaEnd) / 2 * length;
}

double singleScatterReflected(double opticalDepth, double albedo, double phase, double mu,
                              double mu0) {
    const double path = 1 / mu + 1 / mu0;
    return albedo * phase * mu0 / (mu + mu0) * -std::expm1(-opticalDepth * path);
}

double singleScatterTransmitted(double opticalDepth, double albedo, double phase, double mu,
                                double mu0) {
    // (exp(-A) - exp(-B)) / (B - A) with A and B in either order, or equal
    const double in = opticalDepth / mu0, out = opticalDepth / mu;
    const double ratio = std::exp(-std::min(in, out)) * meanOfExp(std::abs(in - out));
    return albedo * phase * out * ratio;
}

double halfSpaceFirstOrderAlbedo(double albedo, double mu) {
    return mu == 0 ? albedo / 2 : albedo / 2 * (1 - mu * std::log1p(1 / mu));
}

double halfSpaceFirstOrderWhiteSkyAlbedo(double albedo) {
    return 2 * albedo / 3 * (1 - std::log(2.0));
}

double airlight(const Airlight& scene, double eye, double from, double to) {
    const double extinction = scene.absorption + scene.scattering, h = scene.offset;
    // At t = h tan(a) the light is h / cos(a) away, dt / distance^2 = da / h, and light that goes
    // on to the eye turns by an angle whose cosine is -sin(a).
    const auto integrand = [&](double a, double) {
        const double t = h * std::tan(a), distance = h / std::cos(a);
        return henyeyGreenstein(-std::sin(a), scene.g) *
               std::exp(-extinction * (t - eye + distance));
    };
    return scene.scattering * scene.intensity / h *
           tanhSinh(integrand, std::atan(from / h), std::atan(to / h));
}

double meanCollisionCount(double albedo) { return 1 / (1 - albedo); }

double meanSquareDistance(int n, double g) {
    // The sum of (n - k) g^k for k below n, by Horner: the closed form cancels as g nears 1.
    double sum = 0;
    for (int remaining = 1; remaining <= n; ++remaining) sum = sum * g + remaining;
    return 2 * sum;
}

double meanChord(double volume, double surface) { return 4 * volume / surface; }
double cubeMeanChord(double edge) { return 2 * edge / 3; }
double sphereMeanChord(double radius) { return 4 * radius / 3; }
double slabMeanChord(double thickness) { return 2 * thickness; }

double henyeyGreenstein(double cosine, double g) {
    const double d = henyeyGreensteinDistance(cosine, g);
    return (1 - g) * (1 + g) / (4 * pi * d * std::sqrt(d));
}

double henyeyGreensteinCdf(double cosine, double g) {
    // The textbook's (1 - g^2) / (2g) (1 / s - 1 / (1 + g)), times s + 1 + g above and below
    const double s = std::sqrt(henyeyGreensteinDistance(cosine, g));
    return (1 - g) * (1 + cosine) / (s * (1 + g + s));
}

}  // namespace woodcock::oracle
