// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "woodcock/trade/estimate.h"

namespace woodcock {

// How the error of a picture falls with time: error(t) = bias^2 + variance x seconds per sample /
// t. Errors are relative squares (relMSE), see estimate.h. Time is that of rendering, as
// --time-limit counts it: what loading takes is the same for all, or nearly.

struct TradeModel {
    double secondsPerSample = 0;  ///< of every pixel once
    Measured squaredBias;         ///< {0, 0} where there is none by construction
    /// Variance of one sample x seconds per sample, from each seed: candidates that were measured
    /// with the same seeds side by side are compared seed by seed.
    std::vector<double> costs;

    double cost() const { return meanOf(costs).value; }
    /// What the bias adds to the error: estimates below zero are noise.
    double biasError() const { return squaredBias.value > 0 ? squaredBias.value : 0; }
    /// With as much bias as two standard errors leave possible: for who will not look twice.
    TradeModel careful() const;
    /// Whole samples of every pixel within `seconds`; 0 where there is no time for one.
    double samplesIn(double seconds) const;
    /// Absent where there is no time for a sample.
    std::optional<Measured> errorAt(double seconds) const;
    /// Absent where the bias alone exceeds the error.
    std::optional<Measured> secondsTo(double error) const;
};

/// Error of a less that of b after so many seconds, which both use for a sample at least.
Measured errorDifference(const TradeModel& a, const TradeModel& b, double seconds);

/// Who does best by some measure: an index, and those that two standard errors of the difference do
/// not tell from it.
struct Winner {
    std::size_t best = 0;
    std::vector<std::size_t> tied;
};
/// The least error after so many seconds; absent where nobody has time for a sample.
std::optional<Winner> bestAt(const std::vector<TradeModel>& models, double seconds);
/// The least time to an error; absent where nobody reaches it.
std::optional<Winner> fastestTo(const std::vector<TradeModel>& models, double error);

/// The lower envelope of the candidates' errors over time, from the first sample of any to
/// `longest` seconds, in steps even in the logarithm.
struct FrontPoint {
    double seconds = 0, error = 0;
    std::size_t candidate = 0;
};
std::vector<FrontPoint> paretoFront(const std::vector<TradeModel>& models, double longest,
                                    int steps);

}  // namespace woodcock
