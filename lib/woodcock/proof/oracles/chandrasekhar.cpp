// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/chandrasekhar.h"

#include <cmath>
#include <iterator>
#include <limits>

#include "woodcock/base/vec.h"
#include "woodcock/proof/oracles/quadrature.h"

namespace woodcock::oracle {

namespace {

/// 1 - x cot(x) as a function of x^2 in [-1/4, 1/4], where the difference would cancel: the sum of
/// |B_2k| (2 x)^2k / (2k)!
double smallOneMinusXCotX(double xx) {
    constexpr double c[]{1.0 / 3,
                         1.0 / 45,
                         2.0 / 945,
                         1.0 / 4725,
                         2.0 / 93555,
                         1382.0 / 638512875,
                         4.0 / 18243225,
                         3617.0 / 162820783125,
                         87734.0 / 38979295480125};
    double sum = 0;
    for (auto i = std::rbegin(c); i != std::rend(c); ++i) sum = (sum + *i) * xx;
    return sum;
}

double oneMinusXCotX(double x) { return x < 0.5 ? smallOneMinusXCotX(x * x) : 1 - x / std::tan(x); }

double yCothYMinusOne(double y) {
    return y < 0.5 ? -smallOneMinusXCotX(-y * y) : y / std::tanh(y) - 1;
}

}  // namespace

double chandrasekharH(double albedo, double mu) {
    if (mu == 0 || albedo == 0) return 1;
    // ln H = -1/pi times the integral of ln(1 - albedo x cot x), tan(angle) = mu tan(x): Stibbs and
    // Weir's integral over x without its peak. Near pi / 2, x is had from the distance to it.
    const double integral = tanhSinh(
        [=](double angle, double fromEnd) {
            const double x = angle < pi / 4 ? std::atan(std::tan(fromEnd) / mu)
                                            : std::atan(1 / (mu * std::tan(fromEnd)));
            return std::log((1 - albedo) + albedo * oneMinusXCotX(x));
        },
        0, pi / 2);
    return std::exp(-integral / pi);
}

double chandrasekharMoment(double albedo, int order) {
    return tanhSinh(
        [=](double mu, double) { return std::pow(mu, order) * chandrasekharH(albedo, mu); }, 0, 1);
}

double halfSpaceAlbedo(double albedo, double mu) { return 1 - halfSpaceEmissivity(albedo, mu); }

double halfSpaceWhiteSkyAlbedo(double albedo) {
    return 1 - 2 * std::sqrt(1 - albedo) * chandrasekharMoment(albedo, 1);
}

double halfSpaceEmissivity(double albedo, double mu) {
    return std::sqrt(1 - albedo) * chandrasekharH(albedo, mu);
}

double halfSpaceRadiance(double albedo, double mu, double mu0) {
    return albedo / (4 * pi) * mu0 / (mu + mu0) * chandrasekharH(albedo, mu) *
           chandrasekharH(albedo, mu0);
}

double milneLimbDarkening(double mu) { return chandrasekharH(1, mu) / chandrasekharH(1, 1); }

double hopfConstant() { return chandrasekharMoment(1, 2) / chandrasekharMoment(1, 1); }

double caseEigenvalue(double albedo) {
    if (albedo == 0) return 1;
    if (albedo == 1) return std::numeric_limits<double>::infinity();
    // With nu = coth(y) the equation is y coth(y) - 1 = (1 - albedo) / albedo, whose left rises and
    // is above y - 1. Bisection until the doubles end.
    const double target = (1 - albedo) / albedo;
    double low = 0, high = 1 + target;
    while (true) {
        const double y = low + (high - low) / 2;
        if (!(y > low && y < high)) return 1 / std::tanh(y);
        (yCothYMinusOne(y) < target ? low : high) = y;
    }
}

}  // namespace woodcock::oracle
