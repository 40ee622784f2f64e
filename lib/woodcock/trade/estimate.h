// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "woodcock/trade/timing.h"

namespace woodcock::trade {

// Estimates of noise and bias from pictures of several seeds. Errors are relative squares: mean
// over pixels and channels of (difference)^2 / (reference^2 + eps^2), where eps is a hundredth of
// the reference's mean. Pixels are independent, so standard errors follow from the scatter of their
// terms. Where the terms differ by more than noise, as with a bias that varies over the picture,
// the standard errors are too large.

/// Three channels for each pixel.
using Pixels = std::vector<float>;

/// Mean over seeds, and the variance of that mean, of each number.
struct SeedMean {
    std::vector<double> mean, variance;
    std::size_t seeds = 0;
    std::size_t pixels() const { return mean.size() / 3; }
};
/// The mean of two seeds or more, of one size.
SeedMean meanOfSeeds(std::span<const Pixels> seeds);

/// 1 / (reference^2 + eps^2), divided by the number of numbers: relative squares are sums of these
/// times squares. Where the reference is 0 everywhere, eps is 1.
std::vector<double> relativeWeights(const SeedMean& reference);

/// Squared difference of two expectations: the mean of all products of differences that share no
/// seed, which is (a - b)^2 less the variances of both. Its expectation is the squared bias, 0
/// where there is none, so it may be negative.
Measured squaredBias(const SeedMean& a, const SeedMean& b, std::span<const double> weights);

/// The error by noise of a mean over seeds.
Measured errorOfMean(const SeedMean& mean, std::span<const double> weights);

/// The error of each seed's picture against the truth that `reference` estimates, whose own error
/// is taken off.
std::vector<double> errorsOfSeeds(std::span<const Pixels> seeds, const SeedMean& reference,
                                  std::span<const double> weights);

/// Estimates, one from each seed, of the variance of one picture; their mean is unbiased.
std::vector<double> variancesOfSeeds(std::span<const Pixels> seeds, const SeedMean& mean,
                                     std::span<const double> weights);

/// Mean of a picture, less that of the reference, relative to the latter (all channels together);
/// 0 where the reference is black.
Measured relativeBias(const SeedMean& a, const SeedMean& reference);

/// Mean of one channel.
Measured channelMean(const SeedMean& mean, int channel);

/// Mean and standard error of independent numbers; one alone has an infinite error.
Measured meanOf(std::span<const double> numbers);

}  // namespace woodcock::trade
