// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/model.h"

#include <algorithm>
#include <cmath>

namespace woodcock::trade {
namespace {

/// The candidate of least `value` (absent: it does not take part), and those whose `difference`
/// from it is not significant.
template <class Value, class Difference>
std::optional<Winner> leastOf(const std::vector<TradeModel>& models, Among among,
                              const Value& value, const Difference& difference) {
    std::vector<std::optional<double>> values;
    for (const TradeModel& model : models) {
        const bool takesPart = among == Among::All || !model.biased;
        const std::optional<Measured> v = takesPart ? value(model) : std::nullopt;
        values.push_back(v && std::isfinite(v->value) ? std::optional(v->value) : std::nullopt);
    }
    const auto isBetter = [&](std::size_t i, std::size_t j) { return *values[i] < *values[j]; };
    std::optional<Winner> winner;
    for (std::size_t i = 0; i < models.size(); ++i)
        if (values[i] && (!winner || isBetter(i, winner->best))) winner = Winner{i, {}, i};
    if (!winner) return winner;
    for (std::size_t i = 0; i < models.size(); ++i) {
        if (i == winner->best || !values[i]) continue;
        const Measured d = difference(models[i], models[winner->best]);
        if (d.value <= tieWidth * d.se) winner->tied.push_back(i);
    }
    for (const std::size_t i : winner->tied)
        if (models[winner->best].biased && !models[i].biased &&
            (models[winner->recommended].biased || isBetter(i, winner->recommended)))
            winner->recommended = i;
    return winner;
}

/// When noise and a bias that falls reach the error, which they do until biasSeconds.
double fallingTo(const TradeModel& model, double error) {
    double low = std::log(model.secondsPerSample), high = std::log(model.biasSeconds);
    constexpr int halvings = 60;
    for (int i = 0; i < halvings && low < high; ++i) {
        const double middle = (low + high) / 2, t = std::exp(middle);
        (model.biasErrorAfter(t) + model.cost() / t > error ? low : high) = middle;
    }
    return std::exp(high);
}

/// Seconds of sampling; absent where the bias alone exceeds the error.
std::optional<Measured> samplingTo(const TradeModel& model, double error) {
    double room = error - model.biasError();
    if (model.costs.empty() || !(room > 0)) return std::nullopt;
    const Measured n = model.noise();
    double seconds = n.value / room;
    if (model.biasPower > 0 && seconds < model.biasSeconds) {
        seconds = fallingTo(model, error);
        room = n.value / seconds;
    }
    return Measured{std::max(model.secondsPerSample, seconds),
                    std::hypot(n.se / room, seconds * model.squaredBias.se / room)};
}

}  // namespace

double TradeModel::biasErrorAfter(double sampling) const {
    if (biasPower == 0) return biasError();
    return biasError() * std::pow(std::max(1.0, biasSeconds / sampling), biasPower);
}

TradeModel TradeModel::careful() const {
    TradeModel model = *this;
    model.squaredBias = {biasError() + 2 * squaredBias.se, squaredBias.se};
    return model;
}

double TradeModel::samplesIn(double seconds) const {
    return std::max(0.0, std::floor((seconds - fixedSeconds) / secondsPerSample));
}

std::optional<Measured> TradeModel::errorAt(double seconds) const {
    const double sampling = seconds - fixedSeconds;
    if (costs.empty() || sampling < secondsPerSample) return std::nullopt;
    const Measured n = noise();
    return Measured{biasErrorAfter(sampling) + n.value / sampling,
                    std::hypot(squaredBias.se, n.se / sampling)};
}

std::optional<Measured> TradeModel::secondsTo(double error) const {
    std::optional<Measured> seconds = samplingTo(*this, error);
    if (seconds) seconds->value += fixedSeconds;
    return seconds;
}

std::optional<double> TradeModel::samplesTo(double error) const {
    const std::optional<Measured> sampling = samplingTo(*this, error);
    if (!sampling) return std::nullopt;
    return std::ceil(sampling->value / secondsPerSample);
}

Measured errorDifference(const TradeModel& a, const TradeModel& b, double seconds) {
    const double ofA = seconds - a.fixedSeconds, ofB = seconds - b.fixedSeconds;
    const double bias = a.biasErrorAfter(ofA) - b.biasErrorAfter(ofB);
    std::vector<double> noise;
    for (std::size_t k = 0; k < std::min(a.costs.size(), b.costs.size()); ++k)
        noise.push_back(a.costs[k] / ofA - b.costs[k] / ofB);
    return {bias + a.cost() / ofA - b.cost() / ofB,
            std::hypot(a.squaredBias.se, b.squaredBias.se, meanOf(noise).se)};
}

std::optional<Winner> bestAt(const std::vector<TradeModel>& models, double seconds, Among among) {
    return leastOf(
        models, among, [&](const TradeModel& m) { return m.errorAt(seconds); },
        [&](const TradeModel& a, const TradeModel& b) { return errorDifference(a, b, seconds); });
}

std::optional<Winner> fastestTo(const std::vector<TradeModel>& models, double error, Among among) {
    return leastOf(
        models, among, [&](const TradeModel& m) { return m.secondsTo(error); },
        [&](const TradeModel& a, const TradeModel& b) {
            const Measured ta = *a.secondsTo(error), tb = *b.secondsTo(error);
            return Measured{ta.value - tb.value, std::hypot(ta.se, tb.se)};
        });
}

std::vector<FrontPoint> paretoFront(const std::vector<TradeModel>& models, double longest,
                                    int steps) {
    double first = longest;
    for (const TradeModel& m : models) first = std::min(first, m.firstSample());
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
