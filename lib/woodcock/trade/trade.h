// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/trade/candidates.h"
#include "woodcock/trade/measure.h"
#include "woodcock/trade/model.h"

namespace woodcock::trade {

// Measures the cost and the error of candidates on one scene, against the scene's own unbiased
// reference. Pictures are rendered smaller than the scene's where the budget demands it. All
// seconds are scaled to the scene's own size, in proportion to pixels, and do not include loading.

struct TradeSettings {
    double budget = 120;  ///< seconds for everything
    int threads = 0;      ///< 0: all cores
    std::uint64_t seed = 0;
    Extent extent = Extent::All;  ///< of the built-in candidates
    bool denoises = true;         ///< candidates may be denoised
    bool crops = false;           ///< also render pictures of equal time to look at
    /// Called with the fraction that is done, and what is being measured; returning false stops.
    std::function<bool(double fraction, const std::string& what)> onProgress = {};
};

struct TradePoint {
    int samples = 0;
    double seconds = 0;
    Measured relMse;               ///< standard error over seeds
    std::optional<Measured> flip;  ///< of one exposure, see flipLdr(); absent: no time for it
};

struct CandidateResult {
    Candidate candidate;
    double loadSeconds = 0;
    std::size_t bytes = 0;      ///< fields and majorants
    Measured secondsPerSample;  ///< wall clock
    Measured cpuSecondsPerSample;
    Measured bias;         ///< of the mean of the picture, relative
    Measured squaredBias;  ///< relative, mean over pixels; below zero by noise alone
    Measured variance;     ///< of one sample, relative: relMSE = variance / samples + squaredBias
    double denoiseSeconds = 0;  ///< of a picture; 0: it is not denoised
    std::vector<TradePoint> points;
    TradeModel model;
    bool onFront = false;
    std::optional<std::size_t> crop;  ///< index into TradeResult::crops

    /// Whether the measured squared bias is more than noise: by three standard errors.
    bool biasResolved() const { return squaredBias.value > 3 * squaredBias.se; }
};

struct TradeReference {
    int samples = 0;  ///< per pixel, all seeds together
    int seeds = 0;
    double seconds = 0;
    Measured error;
    std::array<Measured, 3> mean;
    double noiseShare = 1;  ///< Film::noise()'s square over relMSE, of a picture of this scene
};

struct TradeCrop {
    std::string title;
    Pixels pixels;
};

/// The best candidate at a time or an error.
struct TradeReading {
    double target = 0;
    Winner winner;
};

/// Which seconds of a candidate count.
enum class Counted { Rendering, LoadingToo };

struct TradeResult {
    PictureSize full, measured;
    double seconds = 0;
    TradeReference reference;
    std::vector<CandidateResult> candidates;
    std::vector<FrontPoint> front;
    std::vector<TradeReading> equalTime, equalError;
    std::vector<double> referencePixels;
    std::vector<TradeCrop> crops;  ///< the first is the reference
    std::vector<std::string> notes;

    std::vector<TradeModel> models(Counted counted = Counted::Rendering) const;
};

/// `given` are a user's candidates; without any, the built-in ones. `parse` gives `complete` before
/// it was completed. Absent where onProgress returned false. Throws Error{Usage} where the budget
/// is too small, for anything or for the reference.
std::optional<TradeResult> runTrade(const scene::SceneDescription& complete,
                                    const ParseScene& parse, const std::vector<Candidate>& given,
                                    const TradeSettings& settings);

}  // namespace woodcock::trade
