// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/trade/trade.h"

namespace woodcock::trade {

/// The rendered pictures.
struct TradeMeasurements {
    struct OfCandidate {
        Candidate candidate;
        bool biased = false;
        double loadSeconds = 0;
        std::size_t bytes = 0;
        std::vector<std::vector<Stage>> seeds;  ///< the same stages of each
        bool denoised = false;
    };
    PictureSize full, measured;
    std::vector<OfCandidate> candidates;
    std::vector<Stage> reference;  ///< one for each seed
    double denoiserStart = 0;      ///< seconds that denoising takes however small a picture is

    /// Removes the pictures of round k, from 0.
    void dropRound(int k);
};

/// Evaluates the pictures. FLIP is computed as long as `flipSeconds` last. Throws Error{Usage}
/// where the reference is noisier than the candidates.
TradeResult evaluateTrade(const TradeMeasurements& measurements, double flipSeconds);

}  // namespace woodcock::trade
