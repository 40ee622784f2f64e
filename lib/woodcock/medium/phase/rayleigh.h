// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/medium/phase/turn.h"

namespace woodcock::medium {

/// 3 / (16 pi) (1 + cos^2): what is much smaller than the wavelength, such as air (Rayleigh 1871).
class Rayleigh {
public:
    static constexpr const char* name = "rayleigh";

    double value(double cosine) const { return 3 / (16 * pi) * (1 + cosine * cosine); }
    /// The CDF is a cubic of the cosine, cos^3 + 3 cos = 8u - 4, and cos = 2 sinh(a) makes it
    /// 2 sinh(3a).
    Turn sample(double u) const {
        const double cosine = 2 * std::sinh(std::asinh(4 * u - 2) / 3);
        return {std::max(0.0, 1 - cosine), std::max(0.0, 1 + cosine)};
    }
    double meanCosine() const { return 0; }
};

}  // namespace woodcock::medium
