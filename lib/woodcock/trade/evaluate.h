// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/trade/trade.h"

namespace woodcock {

/// What was rendered.
struct TradeMeasurements {
    struct OfCandidate {
        Candidate candidate;
        bool biased = false;
        double loadSeconds = 0;
        std::size_t bytes = 0;
        std::vector<std::vector<Stage>> seeds;  ///< the same stages of each
    };
    PictureSize full, measured;
    std::vector<OfCandidate> candidates;
    std::vector<Stage> reference;  ///< one for each seed

    /// Takes out what round k, from 0, has rendered.
    void dropRound(int k);
};

/// What it says. FLIP is looked for as long as `flipSeconds` last. Throws Error{Usage} where the
/// reference is noisier than what it is to judge.
TradeResult evaluateTrade(const TradeMeasurements& measurements, double flipSeconds);

}  // namespace woodcock
