// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/phase/mie.h"

#include "woodcock/base/error.h"

namespace woodcock::medium {

MieDroplets::MieDroplets(double diameter) : MieDroplets(fitOf(diameter)) {}

MieDroplets::MieDroplets(const Fit& fit)
    : peak_(fit.gOfPeak), wide_(fit.gOfWide, fit.alpha), share_(fit.share) {}

MieDroplets::Fit MieDroplets::fitOf(double d) {
    if (!(d >= smallestDiameter && d <= largestDiameter))
        throw inputError("diameter is {}; the fits to Mie theory hold from {} to {} micrometres", d,
                         smallestDiameter, largestDiameter);
    if (d >= 5)
        return {.gOfPeak = std::exp(-0.0990567 / (d - 1.67154)),
                .gOfWide = std::exp(-2.20679 / (d + 3.91029) - 0.428934),
                .alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825)),
                .share = std::exp(-0.599085 / (d - 0.641583) - 0.665888)};
    const double l = std::log(d), ll = std::log(l);
    return {.gOfPeak = 0.0604931 * ll + 0.940256,
            .gOfWide = 0.500411 - 0.081287 / (-2 * l + std::tan(l) + 1.27551),
            .alpha = 7.30354 * l + 6.31675,
            .share = 0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))) + 0.3764};
}

}  // namespace woodcock::medium
