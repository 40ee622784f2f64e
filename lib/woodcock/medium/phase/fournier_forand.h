// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "woodcock/medium/phase/turn.h"

namespace woodcock::medium {

/// Particles in sea water, of all sizes by a power law: Fournier and Jonasz 1999, "Computer-based
/// underwater imaging analysis", eq. 3. The slope of the power law follows from the fraction of
/// light that is scattered back (Mobley, Sundman and Boss 2002, "Phase function effects on oceanic
/// light fields", eq. 10).
///
/// The formula has no bound towards straight on. Here the innermost 4 arc seconds are even, with
/// what the formula scatters into them.
class FournierForand {
public:
    static constexpr const char* name = "fournier_forand";
    static constexpr double largestIor = 2;

    /// `ior`: of the particles relative to the water. `backscatter`: the part of light that turns
    /// by more than 90 degrees. Throws Error{Input} where ior is not in (1, 2], or backscatter not
    /// in (0, 0.5).
    FournierForand(double ior, double backscatter);

    double value(double cosine) const { return valueAt((1 - cosine) / 2); }
    Turn sample(double u) const;
    double meanCosine() const { return meanCosine_; }

private:
    // By x = sin^2(angle / 2), from 0 (straight on) to 1.
    double formula(double x) const;  // per steradian
    double cdf(double x) const;      // the part of light that turns by less
    double valueAt(double x) const;

    static constexpr std::size_t steps = 128;
    double nu_, delta_, back_;  // delta_: the variable delta over x
    double peak_;               // the part of light within the even innermost
    double meanCosine_;
    std::array<double, steps + 1> starts_;  // log(x) at even steps of CDF
};

}  // namespace woodcock::medium
