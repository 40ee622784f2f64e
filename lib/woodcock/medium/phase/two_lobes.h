// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/medium/phase/henyey_greenstein.h"

namespace woodcock::medium {

/// (1 - mix) HG(g) + mix HG(g2): a lobe forward and one back, as real particles have them.
class TwoLobes {
public:
    static constexpr const char* name = "two_lobe";

    /// Throws Error{Input} where a g is not in (-1, 1), or mix not in [0, 1].
    TwoLobes(double g, double g2, double mix) : first_(g), second_(g2), mix_(mix) {
        if (!(mix >= 0 && mix <= 1))
            throw inputError("mix is {}; it must lie between 0 and 1", mix);
    }
    double value(double cosine) const {
        return (1 - mix_) * first_.value(cosine) + mix_ * second_.value(cosine);
    }
    Turn sample(double u) const { return turnByEither(u, mix_, first_, second_); }
    double meanCosine() const {
        return (1 - mix_) * first_.meanCosine() + mix_ * second_.meanCosine();
    }
    /// With both lobes' g times `factor`.
    TwoLobes scaled(double factor) const {
        return {first_.g() * factor, second_.g() * factor, mix_};
    }

private:
    HenyeyGreenstein first_, second_;
    double mix_;
};

}  // namespace woodcock::medium
