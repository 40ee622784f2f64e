// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/base/statistics.h"

namespace woodcock::trade {
namespace {

constexpr double epsilonShare = 0.01;

/// The sum over pixels of `term` (which is given the index of a number), with its standard error.
template <class Term>
Measured sumOverPixels(std::size_t pixels, const Term& term) {
    Moments moments;
    for (std::size_t p = 0; p < pixels; ++p)
        moments.add(term(3 * p) + term(3 * p + 1) + term(3 * p + 2));
    const auto n = static_cast<double>(pixels);
    return {n * moments.mean(), n * moments.standardError()};
}

double square(double x) { return x * x; }

double meanOfAll(const SeedMean& m) {
    double sum = 0;
    for (const double v : m.mean) sum += v;
    return sum / static_cast<double>(m.mean.size());
}

}  // namespace

SeedMean meanOfSeeds(std::span<const Pixels> seeds) {
    SeedMean result;
    result.seeds = seeds.size();
    const std::size_t size = seeds.front().size();
    result.mean.resize(size), result.variance.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
        Moments moments;
        for (const Pixels& seed : seeds) moments.add(double{seed[i]});
        result.mean[i] = moments.mean();
        result.variance[i] = square(moments.standardError());
    }
    return result;
}

std::vector<double> relativeWeights(const SeedMean& reference) {
    const double mean = std::abs(meanOfAll(reference));
    const double epsilon = mean > 0 ? epsilonShare * mean : 1;
    std::vector<double> weights;
    for (const double v : reference.mean)
        weights.push_back(
            1 / (static_cast<double>(reference.mean.size()) * (square(v) + square(epsilon))));
    return weights;
}

Measured squaredBias(const SeedMean& a, const SeedMean& b, std::span<const double> weights) {
    return sumOverPixels(a.pixels(), [&](std::size_t i) {
        return weights[i] * (square(a.mean[i] - b.mean[i]) - a.variance[i] - b.variance[i]);
    });
}

Measured errorOfMean(const SeedMean& mean, std::span<const double> weights) {
    return sumOverPixels(mean.pixels(),
                         [&](std::size_t i) { return weights[i] * mean.variance[i]; });
}

std::vector<double> errorsOfSeeds(std::span<const Pixels> seeds, const SeedMean& reference,
                                  std::span<const double> weights) {
    std::vector<double> errors;
    for (const Pixels& seed : seeds)
        errors.push_back(sumOverPixels(reference.pixels(), [&](std::size_t i) {
                             return weights[i] * (square(double{seed[i]} - reference.mean[i]) -
                                                  reference.variance[i]);
                         }).value);
    return errors;
}

std::vector<double> variancesOfSeeds(std::span<const Pixels> seeds, const SeedMean& mean,
                                     std::span<const double> weights) {
    const auto n = static_cast<double>(seeds.size());
    std::vector<double> variances;
    for (const Pixels& seed : seeds)
        variances.push_back(n / (n - 1) * sumOverPixels(mean.pixels(), [&](std::size_t i) {
                                              return weights[i] *
                                                     square(double{seed[i]} - mean.mean[i]);
                                          }).value);
    return variances;
}

Measured relativeBias(const SeedMean& a, const SeedMean& reference) {
    const double mean = meanOfAll(reference);
    if (!(mean > 0)) return {};
    const double size = static_cast<double>(a.mean.size());
    double variance = 0;
    for (std::size_t i = 0; i < a.mean.size(); i += 3) {
        // The channels of a pixel share paths, so they are taken as fully correlated.
        const auto deviation = [i](const SeedMean& m) {
            return std::sqrt(m.variance[i]) + std::sqrt(m.variance[i + 1]) +
                   std::sqrt(m.variance[i + 2]);
        };
        variance += square(deviation(a)) + square(deviation(reference));
    }
    return {(meanOfAll(a) - mean) / mean, std::sqrt(variance) / size / mean};
}

Measured channelMean(const SeedMean& mean, int channel) {
    double sum = 0, variance = 0;
    for (std::size_t i = static_cast<std::size_t>(channel); i < mean.mean.size(); i += 3)
        sum += mean.mean[i], variance += mean.variance[i];
    const auto n = static_cast<double>(mean.pixels());
    return {sum / n, std::sqrt(variance) / n};
}

Measured meanOf(std::span<const double> numbers) {
    Moments moments;
    for (const double x : numbers) moments.add(x);
    return {moments.mean(), moments.count() > 1 ? moments.standardError()
                                                : std::numeric_limits<double>::infinity()};
}

}  // namespace woodcock::trade
