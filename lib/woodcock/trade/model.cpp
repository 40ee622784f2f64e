// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace woodcock::trade {
namespace {

/// The candidate of least `value` (absent: it does not take part), and those whose `difference`
/// from it is not significant.
template <class Value, class Difference>
std::optional<Winner> leastOf(const std::vector<TradeModel>& models, const Value& value,
                              const Difference& difference) {
    std::optional<Winner> winner;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < models.size(); ++i)
        if (const std::optional<Measured> v = value(models[i]); v && v->value < least)
            least = v->value, winner = Winner{i, {}};
    if (!winner) return winner;
    for (std::size_t i = 0; i < models.size(); ++i) {
        if (i == winner->best || !value(models[i])) continue;
        const Measured d = difference(models[i], models[winner->best]);
        if (d.value <= tieWidth * d.se) winner->tied.push_back(i);
    }
    return winner;
}

}  // namespace

TradeModel TradeModel::careful() const {
    TradeModel model = *this;
    model.squaredBias = {biasError() + 2 * squaredBias.se, squaredBias.se};
    return model;
}

double TradeModel::samplesIn(double seconds) const {
    return std::max(0.0, std::floor(seconds / secondsPerSample));
}

std::optional<Measured> TradeModel::errorAt(double seconds) const {
    if (seconds < secondsPerSample) return std::nullopt;
    const Measured n = noise();
    return Measured{biasError() + n.value / seconds, std::hypot(squaredBias.se, n.se / seconds)};
}

std::optional<Measured> TradeModel::secondsTo(double error) const {
    const double room = error - biasError();
    if (!(room > 0)) return std::nullopt;
    const Measured n = noise();
    const double seconds = n.value / room;
    return Measured{std::max(secondsPerSample, seconds),
                    std::hypot(n.se / room, seconds * squaredBias.se / room)};
}

double noiseDifferenceError(const TradeModel& a, const TradeModel& b) {
    const std::size_t common = std::min(a.costs.size(), b.costs.size());
    std::vector<double> paired;
    for (std::size_t k = 0; k < common; ++k) paired.push_back(a.costs[k] - b.costs[k]);
    return meanOf(paired).se;
}

Measured errorDifference(const TradeModel& a, const TradeModel& b, double seconds) {
    const double bias = a.biasError() - b.biasError();
    const double biasVariance = std::pow(a.squaredBias.se, 2) + std::pow(b.squaredBias.se, 2);
    return {bias + (a.cost() - b.cost()) / seconds,
            std::sqrt(biasVariance + std::pow(noiseDifferenceError(a, b) / seconds, 2))};
}

std::optional<Winner> bestAt(const std::vector<TradeModel>& models, double seconds) {
    return leastOf(
        models, [&](const TradeModel& m) { return m.errorAt(seconds); },
        [&](const TradeModel& a, const TradeModel& b) { return errorDifference(a, b, seconds); });
}

std::optional<Winner> fastestTo(const std::vector<TradeModel>& models, double error) {
    return leastOf(
        models, [&](const TradeModel& m) { return m.secondsTo(error); },
        [&](const TradeModel& a, const TradeModel& b) {
            const Measured ta = *a.secondsTo(error), tb = *b.secondsTo(error);
            return Measured{ta.value - tb.value, std::hypot(ta.se, tb.se)};
        });
}

std::vector<FrontPoint> paretoFront(const std::vector<TradeModel>& models, double longest,
                                    int steps) {
    double first = longest;
    for (const TradeModel& m : models) first = std::min(first, m.secondsPerSample);
    first *= 1 + 1e-9;  // the first sample ends within it, rounding or not
    std::vector<FrontPoint> front;
    for (int i = 0; i < steps && first < longest; ++i) {
        const double seconds = first * std::pow(longest / first, double(i) / (steps - 1));
        if (const auto winner = bestAt(models, seconds))
            front.push_back({seconds, models[winner->best].errorAt(seconds)->value, winner->best});
    }
    return front;
}

}  // namespace woodcock::trade
