// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace woodcock::compare {

/// relMSE is the mean of (b - a)^2 / (a^2 + this).
inline constexpr double relMseEpsilon = 0.01;

struct PixelDifference {
    int x = 0, y = 0;
    double a = 0, b = 0;
};

/// Differences of channel b from the reference a, over the pixels that are finite in both.
struct DifferenceMetrics {
    std::size_t pixels = 0;  ///< finite in both; if 0, the other members are void
    std::size_t nonFiniteA = 0, nonFiniteB = 0, nonFiniteInOne = 0;
    double meanA = 0, meanB = 0;
    double rmse = 0, relMse = 0;
    double peak = 0;                       ///< the largest |a|
    double psnr = 0;                       ///< 10 log10(peak^2 / MSE), infinite for equal channels
    std::vector<PixelDifference> largest;  ///< at most five, the largest first
};

DifferenceMetrics differenceMetrics(std::span<const float> a, std::span<const float> b, int width);

}  // namespace woodcock::compare
