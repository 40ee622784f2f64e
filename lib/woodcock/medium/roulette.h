// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "woodcock/base/random.h"
#include "woodcock/base/spectrum.h"

namespace woodcock::medium {

/// Russian roulette in one draw: a path survives while its weight stays above u x threshold. The
/// probability of that is its lowest weight / threshold, by which a survivor is divided. The final
/// weight will not do: where channels differ, weights may rise again.
class Roulette {
public:
    Roulette(float threshold, RandomStream& random)
        : threshold_(threshold),
          lowest_(threshold),
          killBelow_(threshold > 0 ? threshold * static_cast<float>(random.uniformOpenLow()) : 0) {}
    /// The weight below which this ray ends.
    float killBelow() const { return killBelow_; }
    bool kills(float weight) {
        lowest_ = std::min(lowest_, weight);
        return weight < killBelow_;
    }
    template <int N>
    void lift(Spectrum<N>& weight) const {
        if (lowest_ > 0 && lowest_ < threshold_) weight *= threshold_ / lowest_;
    }

private:
    float threshold_, lowest_, killBelow_;
};

}  // namespace woodcock::medium
