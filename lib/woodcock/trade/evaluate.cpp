// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/evaluate.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/base/parse.h"
#include "woodcock/compare/flip.h"

namespace woodcock::trade {
namespace {

/// Each is read where it tells something: at least this many samples of the scene as it is.
constexpr double fewestSamples = 4;
constexpr std::size_t mostReadings = 4;
constexpr double readableTimes[]{0.1, 1, 10, 60, 600, 3600, 36000, 360000};
constexpr double readableErrors[]{1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
constexpr double longestReading = 360000;
constexpr int frontSteps = 60;
/// Above, the weights of relMSE are noise themselves.
constexpr double largestReferenceError = 0.5;

using OfCandidate = TradeMeasurements::OfCandidate;

std::vector<Pixels> picturesAt(const OfCandidate& m, std::size_t stage) {
    std::vector<Pixels> pictures;
    for (const std::vector<Stage>& seed : m.seeds) pictures.push_back(seed[stage].pixels);
    return pictures;
}

/// Of something that each seed tells at a stage.
template <class Value>
Measured overSeeds(const OfCandidate& m, std::size_t stage, const Value& value) {
    std::vector<double> values;
    for (const std::vector<Stage>& seed : m.seeds) values.push_back(value(seed[stage]));
    return meanOf(values);
}

class Evaluation {
public:
    Evaluation(const TradeMeasurements& m, double flipSeconds) : m_(m), flipSeconds_(flipSeconds) {
        std::vector<Pixels> pictures;
        for (const Stage& seed : m.reference) pictures.push_back(seed.pixels);
        reference_ = meanOfSeeds(pictures);
        weights_ = relativeWeights(reference_);
        referenceFloats_.assign(reference_.mean.begin(), reference_.mean.end());
        scale_ = m.full.pixels() / m.measured.pixels();
    }

    TradeResult run() {
        TradeResult result;
        result.full = m_.full, result.measured = m_.measured;
        result.referencePixels = reference_.mean;
        TradeReference& r = result.reference;
        r.seeds = static_cast<int>(m_.reference.size());
        for (const Stage& seed : m_.reference) r.samples += seed.samples, r.seconds += seed.seconds;
        r.error = errorOfMean(reference_, weights_);
        r.noiseShare = noiseShare(r.error.value);
        for (int c = 0; c < 3; ++c)
            r.mean[static_cast<std::size_t>(c)] = channelMean(reference_, c);

        result.candidates.resize(m_.candidates.size());
        tbb::parallel_for(std::size_t{0}, m_.candidates.size(), [&](std::size_t i) {
            result.candidates[i] = evaluate(m_.candidates[i]);
        });
        checkReference(result);
        return result;
    }

private:
    /// `error`: of the mean of the reference's seeds.
    double noiseShare(double error) const {
        double square = 0;
        for (const Stage& seed : m_.reference) square += seed.noise * seed.noise;
        const auto seeds = static_cast<double>(m_.reference.size());
        const double share = square / seeds / (error * seeds);
        return std::isfinite(share) && share > 0 ? share : 1;
    }

    CandidateResult evaluate(const OfCandidate& m) const {
        CandidateResult r;
        r.candidate = m.candidate;
        r.loadSeconds = m.loadSeconds;
        r.bytes = m.bytes;
        const std::size_t last = m.seeds.front().size() - 1;
        const std::vector<Pixels> pictures = picturesAt(m, last);
        const SeedMean mean = meanOfSeeds(pictures);
        r.secondsPerSample =
            overSeeds(m, last, [&](const Stage& s) { return scale_ * s.seconds / s.samples; });
        r.cpuSecondsPerSample =
            overSeeds(m, last, [&](const Stage& s) { return scale_ * s.cpuSeconds / s.samples; });
        r.bias = relativeBias(mean, reference_);
        r.squaredBias = squaredBias(mean, reference_, weights_);

        std::vector<double> variances = variancesOfSeeds(pictures, mean, weights_);
        for (std::size_t k = 0; k < variances.size(); ++k) {
            variances[k] *= m.seeds[k][last].samples;
            r.model.costs.push_back(variances[k] * scale_ * m.seeds[k][last].seconds /
                                    m.seeds[k][last].samples);
        }
        r.variance = meanOf(variances);
        r.model.secondsPerSample = r.secondsPerSample.value;
        r.model.biased = m.biased;
        if (m.biased) r.model.squaredBias = r.squaredBias;
        if (m.denoised) weighDenoising(m, r);
        for (std::size_t stage = 0; stage <= last; ++stage) r.points.push_back(point(m, stage));
        return r;
    }

    /// Seconds at the full size.
    double denoising(const Stage& stage) const {
        if (stage.denoiseSeconds == 0) return 0;
        const double start = std::min(m_.denoiserStart, stage.denoiseSeconds);
        return start + scale_ * (stage.denoiseSeconds - start);
    }

    /// How long it takes, and how the bias, which is that of the last stage, falls until then.
    void weighDenoising(const OfCandidate& m, CandidateResult& r) const {
        const std::size_t last = m.seeds.front().size() - 1;
        r.denoiseSeconds = overSeeds(m, last, [&](const Stage& s) { return denoising(s); }).value;
        r.model.fixedSeconds = r.denoiseSeconds;
        r.model.biasSeconds =
            overSeeds(m, last, [&](const Stage& s) { return scale_ * s.seconds; }).value;
        const Measured first =
            trade::squaredBias(meanOfSeeds(picturesAt(m, 0)), reference_, weights_);
        const Measured& end = r.squaredBias;
        if (last == 0 || first.value <= 3 * first.se || end.value <= 3 * end.se) return;
        const double samples =
            double(m.seeds.front()[last].samples) / double(m.seeds.front()[0].samples);
        // Faster than noise falls, noise made it.
        r.model.biasPower =
            std::clamp(std::log(first.value / end.value) / std::log(samples), 0.0, 1.0);
    }

    TradePoint point(const OfCandidate& m, std::size_t stage) const {
        TradePoint point;
        const std::vector<Pixels> pictures = picturesAt(m, stage);
        point.samples = m.seeds.front()[stage].samples;
        point.seconds = overSeeds(m, stage, [&](const Stage& s) {
                            return scale_ * s.seconds + denoising(s);
                        }).value;
        point.relMse = meanOf(errorsOfSeeds(pictures, reference_, weights_));
        std::vector<double> flips;
        for (const Pixels& picture : pictures) {
            if (watch_.seconds() > flipSeconds_) return point;
            flips.push_back(flip(picture));
        }
        point.flip = meanOf(flips);
        return point;
    }

    double flip(const Pixels& picture) const {
        const std::vector<float> map =
            compare::flipLdr(referenceFloats_, picture, m_.measured.width, m_.measured.height);
        double sum = 0;
        for (const float v : map) sum += double{v};
        return sum / static_cast<double>(map.size());
    }

    void checkReference(const TradeResult& result) const {
        const auto best =
            std::min_element(result.candidates.begin(), result.candidates.end(),
                             [](const CandidateResult& a, const CandidateResult& b) {
                                 return a.points.back().relMse.value < b.points.back().relMse.value;
                             });
        const double bestError = best->points.back().relMse.value;
        const double error = result.reference.error.value;
        if (error <= bestError && error <= largestReferenceError) return;
        throw usageError(
            "the budget is too small for the reference to converge: its relMSE is {:.2g} after {} "
            "samples per pixel; that of the best candidate, '{}', is {:.2g}; give more time by "
            "--budget, or a smaller --res",
            error, result.reference.samples, best->candidate.name, bestError);
    }

    const TradeMeasurements& m_;
    const double flipSeconds_;
    const Stopwatch watch_;
    SeedMean reference_;
    Pixels referenceFloats_;
    std::vector<double> weights_;
    double scale_ = 1;
};

void readTimes(TradeResult& result) {
    const std::vector<TradeModel> models = result.models();
    const TradeModel& plain = models.front();
    for (const double seconds : readableTimes) {
        if (plain.samplesIn(seconds) < fewestSamples) continue;
        if (const auto winner = bestAt(models, seconds))
            result.equalTime.push_back({seconds, *winner});
        if (result.equalTime.size() == mostReadings) return;
    }
}

void readErrors(TradeResult& result) {
    const std::vector<TradeModel> models = result.models();
    for (const double error : readableErrors) {
        const auto winner = fastestTo(models, error);
        if (!winner) continue;
        const TradeModel& best = models[winner->best];
        const double seconds = best.secondsTo(error)->value;
        if (best.samplesIn(seconds) < fewestSamples || seconds > longestReading) continue;
        result.equalError.push_back({error, *winner});
        if (result.equalError.size() == mostReadings) return;
    }
}

void readFront(TradeResult& result) {
    double longest = 0;
    for (const TradeReading& r : result.equalTime) longest = std::max(longest, r.target);
    result.front = paretoFront(result.models(), longest, frontSteps);
    for (const FrontPoint& point : result.front) result.candidates[point.candidate].onFront = true;
}

/// The first few by name.
std::string namesOf(const TradeResult& result, const std::vector<std::size_t>& indices) {
    constexpr std::size_t most = 5;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(most, indices.size()); ++i)
        names.push_back(fmt::format("'{}'", result.candidates[indices[i]].candidate.name));
    return fmt::format(
        "{}{}", fmt::join(names, ", "),
        indices.size() > most ? fmt::format(" and {} more", indices.size() - most) : "");
}

void noteTies(TradeResult& result) {
    for (const TradeReading& r : result.equalTime)
        if (!r.winner.tied.empty())
            result.notes.push_back(fmt::format(
                "the budget was too small to tell {} from '{}' at {}",
                namesOf(result, r.winner.tied), result.candidates[r.winner.best].candidate.name,
                formatDuration(r.target)));
    std::vector<std::size_t> unresolved;
    for (std::size_t i = 0; i < result.candidates.size(); ++i)
        if (result.candidates[i].model.biased && !result.candidates[i].biasResolved())
            unresolved.push_back(i);
    if (!unresolved.empty())
        result.notes.push_back(
            fmt::format("no bias was found beyond noise in {}", namesOf(result, unresolved)));
}

void noteDenoising(TradeResult& result) {
    for (const CandidateResult& c : result.candidates)
        if (c.denoiseSeconds > 0)
            result.notes.push_back(fmt::format(
                "'{}' is denoised, in {}: variance and bias are those of {} samples. With fewer, "
                "the squared bias is taken to rise as samples^-{:.2g}; with more, to stay",
                c.candidate.name, formatDuration(c.denoiseSeconds), c.points.back().samples,
                c.model.biasPower));
}

}  // namespace

void TradeMeasurements::dropRound(int k) {
    for (OfCandidate& c : candidates)
        c.seeds.resize(std::min(c.seeds.size(), static_cast<std::size_t>(k)));
    const std::size_t rounds =
        static_cast<std::size_t>(k) * static_cast<std::size_t>(tradeReferenceSeeds / tradeSeeds);
    reference.resize(std::min(reference.size(), rounds));
}

std::vector<TradeModel> TradeResult::models(Counted counted) const {
    std::vector<TradeModel> all;
    for (const CandidateResult& c : candidates) {
        all.push_back(c.model);
        if (counted == Counted::LoadingToo) all.back().fixedSeconds += c.loadSeconds;
    }
    return all;
}

TradeResult evaluateTrade(const TradeMeasurements& measurements, double flipSeconds) {
    TradeResult result = Evaluation(measurements, flipSeconds).run();
    readTimes(result);
    readErrors(result);
    readFront(result);
    noteTies(result);
    noteDenoising(result);
    return result;
}

}  // namespace woodcock::trade
