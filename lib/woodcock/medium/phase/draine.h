// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/medium/phase/turn.h"

namespace woodcock::medium {

/// Draine 2003, "Scattering by Interstellar Dust Grains. I. Optical and Ultraviolet", eq. 4:
/// Henyey-Greenstein of g times 1 + alpha cos^2. alpha 0 is Henyey-Greenstein, alpha 1
/// Cornette-Shanks, and with g 0 Rayleigh.
class Draine {
public:
    static constexpr const char* name = "draine";

    /// Throws Error{Input} where g is not in (-1, 1), or alpha negative or not finite.
    Draine(double g, double alpha);

    double g() const { return g_; }
    double alpha() const { return alpha_; }
    double value(double cosine) const;
    Turn sample(double u) const;
    double meanCosine() const;

private:
    double g_, alpha_, norm_;
};

}  // namespace woodcock::medium
