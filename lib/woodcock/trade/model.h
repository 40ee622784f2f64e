// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "woodcock/trade/estimate.h"

namespace woodcock::trade {

// How the error of a picture falls with time: error(t) = bias^2 + variance x seconds per sample /
// t. Errors are relative squares (relMSE), see estimate.h. Time is that of rendering, as
// --time-limit counts it, and of denoising, unless a model says what its loading takes, too. The
// bias of a denoised picture falls with its noise.

struct TradeModel {
    double secondsPerSample = 0;  ///< of every pixel once
    Measured squaredBias;         ///< {0, 0} where there is none by construction
    /// Variance of one sample x seconds per sample, from each seed: candidates that were measured
    /// with the same seeds side by side are compared seed by seed. Empty where nothing was
    /// measured: such a candidate takes part in nothing.
    std::vector<double> costs;
    bool biased = false;      ///< by construction, whatever was measured
    double fixedSeconds = 0;  ///< that pass beside sampling: denoising, and loading where it counts
    /// The squared bias falls with this power of the time, until `biasSeconds` of sampling, when it
    /// was measured; from then on it is taken to stay. 0: it is the same from the start.
    double biasPower = 0, biasSeconds = 0;

    Measured noise() const { return meanOf(costs); }
    double cost() const { return noise().value; }
    /// The bias's part of the error; estimates below zero are noise and count as 0.
    double biasError() const { return squaredBias.value > 0 ? squaredBias.value : 0; }
    /// The same after so many seconds of sampling.
    double biasErrorAfter(double sampling) const;
    /// The error with the bias raised by two standard errors: a safe choice without a second
    /// measurement.
    TradeModel careful() const;
    /// When the first sample of every pixel ends.
    double firstSample() const { return fixedSeconds + secondsPerSample; }
    /// Whole samples of every pixel within `seconds`; 0 where there is no time for one.
    double samplesIn(double seconds) const;
    /// Absent where there is no time for a sample.
    std::optional<Measured> errorAt(double seconds) const;
    /// Absent where the bias alone exceeds the error.
    std::optional<Measured> secondsTo(double error) const;
    /// Whole samples of every pixel that it takes; likewise.
    std::optional<double> samplesTo(double error) const;
};

/// Error of a minus that of b after so many seconds, in which both render at least a sample. Its
/// standard error is that of the mean of the seeds' differences.
Measured errorDifference(const TradeModel& a, const TradeModel& b, double seconds);

/// Standard errors of a difference within which two candidates are tied.
constexpr double tieWidth = 2;

/// The best candidate by some measure, as an index, and what it says of the others.
struct Winner {
    std::size_t best = 0;
    std::vector<std::size_t> tied;  ///< within two standard errors of the difference
    /// The best; where that is biased, the best of the unbiased ones that are tied with it.
    std::size_t recommended = 0;
};
/// Which candidates take part.
enum class Among { All, Unbiased };
/// The candidate of least error after so many seconds; absent where none has time for a sample.
std::optional<Winner> bestAt(const std::vector<TradeModel>& models, double seconds,
                             Among among = Among::All);
/// The candidate of least time to an error; absent where none reaches it.
std::optional<Winner> fastestTo(const std::vector<TradeModel>& models, double error,
                                Among among = Among::All);

/// The lower envelope of the candidates' errors over time, from the first sample of any to
/// `longest` seconds, in steps even in the logarithm.
struct FrontPoint {
    double seconds = 0, error = 0;
    std::size_t candidate = 0;
};
std::vector<FrontPoint> paretoFront(const std::vector<TradeModel>& models, double longest,
                                    int steps);

}  // namespace woodcock::trade
