// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase/draine.h"

#include "woodcock/medium/phase/henyey_greenstein.h"

namespace woodcock::medium {

Draine::Draine(double g, double alpha)
    : g_(HenyeyGreenstein(g).g()), alpha_(alpha), norm_(1 + alpha * (1 + 2 * g * g) / 3) {
    if (!(alpha >= 0 && std::isfinite(alpha)))
        throw inputError("alpha is {}; it must be 0 or more, and finite", alpha);
}

double Draine::value(double cosine) const {
    return henyeyGreenstein(cosine, g_) * (1 + alpha_ * cosine * cosine) / norm_;
}

double Draine::meanCosine() const { return g_ * (1 + alpha_ * (3 + 2 * g_ * g_) / 5) / norm_; }

/// Inverts the CDF by Newton's method, kept within bounds by bisection. With e = 1 - |g| and s =
/// sqrt(1 + g^2 - 2|g| cos) = e + |g| x, the variable x runs from 0 (straight on) to 2, and 1 - cos
/// = x (e + s) / 2. In x the density is (1 - g^2) (1 + alpha cos^2) / (2 s^2 norm), and its
/// integral is (1 + |g|) x / (2 s norm) times 1 + alpha (1 - e x + e^2 x^2 / 3 + e |g| x^3 / 12),
/// for any g without cancellation.
Turn Draine::sample(double u) const {
    const double g = std::abs(g_), e = 1 - g;
    const double wanted = u * norm_;
    double least = 0, most = 2;
    double x = 2 * u * e / (1 + g - 2 * u * g);  // exact where alpha is 0
    for (int i = 0; i < 100; ++i) {
        const double s = e + g * x, cosine = 1 - x * (e + s) / 2;
        const double ex = e * x;
        const double cdf =
            (1 + g) * x / (2 * s) * (1 + alpha_ * (1 - ex + ex * ex / 3 + e * g * x * x * x / 12));
        const double density = (1 + g) * e / (2 * s * s) * (1 + alpha_ * cosine * cosine);
        (cdf < wanted ? least : most) = x;
        double next = x - (cdf - wanted) / density;
        if (!(next >= least && next <= most)) next = (least + most) / 2;
        const double change = std::abs(next - x);
        x = next;
        if (change <= 1e-9 * x) break;  // and this step left its square
    }
    const double below = std::min(2.0, x * (e + g * x / 2));
    const Turn turn{below, 2 - below};
    return g_ < 0 ? turn.reversed() : turn;
}

}  // namespace woodcock::medium
