// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/medium/phase/draine.h"
#include "woodcock/medium/phase/henyey_greenstein.h"

namespace woodcock::medium {

/// Droplets of water in air: a mixture of Henyey-Greenstein's and Draine's functions, fitted to Mie
/// theory by Jendersie and d'Eon 2023, "An Approximate Mie Scattering Function for Fog and Cloud
/// Rendering", eq. 4 to 7, and for less than 5 micrometres the fits of its supplement. A smooth
/// fit has neither rainbow nor glory.
class MieDroplets {
public:
    static constexpr const char* name = "mie";
    static constexpr double smallestDiameter = 1.5, largestDiameter = 50;  ///< micrometres

    /// Throws Error{Input} where the diameter, in micrometres, is outside of the fits' range.
    explicit MieDroplets(double diameter);

    double value(double cosine) const {
        return (1 - share_) * peak_.value(cosine) + share_ * wide_.value(cosine);
    }
    Turn sample(double u) const { return turnByEither(u, share_, peak_, wide_); }
    double meanCosine() const {
        return (1 - share_) * peak_.meanCosine() + share_ * wide_.meanCosine();
    }
    const HenyeyGreenstein& peak() const { return peak_; }
    const Draine& wide() const { return wide_; }
    double shareOfWide() const { return share_; }

private:
    struct Fit {
        double gOfPeak, gOfWide, alpha, share;
    };
    static Fit fitOf(double diameter);
    explicit MieDroplets(const Fit& fit);

    HenyeyGreenstein peak_;
    Draine wide_;
    double share_;
};

}  // namespace woodcock::medium
