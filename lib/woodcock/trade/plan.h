// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace woodcock::trade {

// Shares a budget of seconds among pictures, each of which is rendered with several seeds.

inline constexpr int tradeSeeds = 4;           ///< of each candidate
inline constexpr int tradeReferenceSeeds = 8;  ///< of the reference, with which all are compared
inline constexpr int mostTradeSeeds = 8;       ///< of each candidate, where there is time for more

struct PilotCost {
    double secondsPerSample = 0;  ///< of every pixel
    double variance = 0;          ///< of one sample
    double weight = 1;            ///< how much its error matters
};

/// Samples per pixel of each seed.
struct TradePlan {
    std::vector<int> candidates;
    int reference = 0;
    double seconds = 0;  ///< that it takes
};

/// Errors of squared biases are proportional to variance / samples of candidate and reference
/// together. Their weighted sum is least where each gets time in proportion to the square root of
/// weight x variance x seconds per sample (Neyman 1934, allocation); the reference's weight is the
/// sum of all. None gets less than `least` samples, so the plan may take longer than `seconds`.
TradePlan planTrade(const std::vector<PilotCost>& candidates, const PilotCost& reference,
                    double seconds, int least);

/// A size in the shape of width x height with about so many pixels, at most its own.
struct PictureSize {
    int width = 1, height = 1;
    double pixels() const { return double(width) * height; }
};
PictureSize sizeOfPixels(PictureSize full, double pixels);

/// Samples per pixel of the least plan, for all pictures and the pilot together.
double leastSamplesPerPixel(std::size_t candidates);
/// Samples per pixel of a plan that can distinguish candidates.
double goodSamplesPerPixel(std::size_t candidates);

}  // namespace woodcock::trade
