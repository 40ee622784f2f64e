// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/spread.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/vec.h"

namespace woodcock::light {

Spread::Spread(double degrees) : degrees_(degrees), even_(degrees >= 180) {
    if (even_) return;
    const double a = degrees * pi / 360, a2 = a * a;
    tangent_ = std::tan(a);
    // The series where the difference would lose its digits.
    rest_ = a < 0.03 ? a * a2 * (1.0 / 3 + a2 * (2.0 / 15 + a2 * (17.0 / 315 + a2 * 62.0 / 2835)))
                     : tangent_ - a;
}

double Spread::factor(double cosine) const {
    if (even_) return 1;
    if (!(cosine > 0)) return 0;
    const double tangent = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))) / cosine;
    return std::max(0.0, tangent_ - tangent) / rest_;
}

}  // namespace woodcock::light
