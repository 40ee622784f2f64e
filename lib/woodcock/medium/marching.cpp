// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/marching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/medium/look_up.h"
#include "woodcock/medium/roulette.h"

namespace woodcock::medium {

namespace {

/// The most lookups that one ray may need of one part.
constexpr double mostLookUps = 1e6;
/// An optical depth that lets nothing through, but is finite.
constexpr double opaque = 1e4;

/// A number for each channel, in the precision of optical depths.
template <int N>
struct Numbers {
    std::array<double, static_cast<std::size_t>(N)> c{};
    double& operator[](int i) { return c[static_cast<std::size_t>(i)]; }
    double operator[](int i) const { return c[static_cast<std::size_t>(i)]; }
};

/// -ln cos(x), to all digits where x is small, as it mostly is.
double minusLogCosine(double x) {
    const double x2 = x * x;
    if (x2 < 0.01) return x2 * (1.0 / 2 + x2 * (1.0 / 12 + x2 * (1.0 / 45 + x2 * (17.0 / 2520))));
    const double cosine = std::cos(x);
    return cosine > 0 ? -std::log(cosine) : opaque;
}

/// A part of a ray along which the extinction is taken as constant.
template <int N>
struct Step {
    double t0 = 0, t1 = 0;  ///< t1 may be infinite
    Numbers<N> rate{};      ///< per unit of t
    Spectrum<N> f;          ///< where `exact`: the field's value
    bool exact = false;

    /// Optical depth from t0 to t.
    double depth(int c, double t) const { return rate[c] > 0 ? rate[c] * (t - t0) : 0; }
};

/// The steps of one part along a ray, in order. Empty steps are left out. The field is read in
/// full: one-tap stochastic interpolation adds variance, and with it bias.
template <int N>
class March {
public:
    template <class Query>
    March(const MediumPart& part, const MarchSettings& settings, const Query& q,
          RandomStream random)
        : part_(&part),
          ray_(part.indexRay(q.origin, q.direction, q.time)),
          walk_(part, part.marchCells(), ray_, q.tMax),
          time_(q.time),
          stepsPerLength_(length(ray_.direction) / settings.step),
          jackknife_(settings.jackknife),
          random_(random) {}

    const MediumPart& part() const { return *part_; }
    /// f at `t` of the ray.
    Spectrum<N> density(double t) const {
        return densityAt<N>(*part_, ray_.at(t), time_, InFull{});
    }

    bool next(Step<N>& step, TrackingCounters& counters) {
        while (done_ == count_) {
            if (!walk_.next(segment_)) return false;
            ++counters.segments;
            done_ = 0, count_ = 0;
            if (!(segment_.range.max > 0 && segment_.t1 > segment_.t0)) continue;
            if (known(step)) return true;
            // Rounding must not add a step.
            const double steps = (segment_.t1 - segment_.t0) * stepsPerLength_ * (1 - 1e-9);
            count_ = 1 + static_cast<std::int64_t>(std::min(steps, mostLookUps));
        }
        const double width = (segment_.t1 - segment_.t0) / static_cast<double>(count_);
        step.t0 = segment_.t0 + width * static_cast<double>(done_++);
        step.t1 = done_ == count_ ? segment_.t1 : step.t0 + width;
        step.exact = false;
        estimate(step, counters);
        return true;
    }

private:
    /// Takes the step exactly where the field is constant, and beyond its support.
    bool known(Step<N>& step) const {
        if (segment_.range.min == segment_.range.max)
            step.f = Spectrum<N>(segment_.range.min);
        else if (!walk_.insideSupport(segment_))
            step.f = Spectrum<N>::map([&](int c) { return part_->field()->background(c); });
        else
            return false;
        step.t0 = segment_.t0, step.t1 = segment_.t1;
        step.exact = true;
        for (int c = 0; c < N; ++c) step.rate[c] = double{part_->extinction()[c]} * step.f[c];
        return true;
    }

    /// See MarchSettings::jackknife.
    void estimate(Step<N>& step, TrackingCounters& counters) {
        const double width = step.t1 - step.t0;
        const auto look = [&] {
            ++counters.collisions;
            return density(step.t0 + width * random_.uniform());
        };
        const Spectrum<N> a = look();
        const Spectrum<N> b = jackknife_ ? look() : a;
        for (int c = 0; c < N; ++c) {
            const double half = 0.5 * double{part_->extinction()[c]};
            double rate = half * (double{a[c]} + b[c]);
            if (jackknife_ && width > 0)
                rate += minusLogCosine(half * (double{a[c]} - b[c]) * width) / width;
            step.rate[c] = rate;
        }
    }

    const MediumPart* part_;
    grid::IndexRay ray_;
    PartWalk walk_;
    float time_;
    double stepsPerLength_;
    bool jackknife_;
    RandomStream random_;
    grid::Segment segment_{0, 0, {}};
    std::int64_t done_ = 0, count_ = 0;  // steps of the segment
};

/// Where a ray interacts.
template <int N>
struct Event {
    double t;
    int part = -1;       ///< none: the ray reaches t
    Spectrum<N> f = {};  ///< there
};

/// Optical depths of one part from the ray's start to `t`, by the same steps as before.
template <int N>
void addDepth(March<N> march, double t, Numbers<N>& depth, TrackingCounters& counters) {
    Step<N> step;
    while (march.next(step, counters) && step.t0 < t)
        for (int c = 0; c < N; ++c) depth[c] += step.depth(c, std::min(t, step.t1));
}

/// The point of an event of channel c within a step. One of four points is chosen in proportion to
/// the field there (resampling: Talbot et al. 2005). The four are stratified as by a constant
/// extinction. Without this, scattering would be blurred by the width of a step.
template <int N>
double placeWithin(const Step<N>& step, const March<N>& march, int c, RandomStream& random,
                   Spectrum<N>& f, TrackingCounters& counters) {
    constexpr int count = 4;
    std::array<double, count> t;
    std::array<Spectrum<N>, count> values;
    const double rate = step.rate[c], width = step.t1 - step.t0;
    float sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double u = (static_cast<double>(i) + random.uniform()) / count;
        const double along = -std::log1p(u * std::expm1(-rate * width)) / rate;
        t[i] = step.t0 + std::min(along, width);
        ++counters.collisions;
        values[i] = march.density(t[i]);
        sum += values[i][c];
    }
    if (!(sum > 0)) {  // then only the step's own estimate is known
        f = Spectrum<N>::map([&](int k) {
            const float extinction = march.part().extinction()[k];
            return extinction > 0 ? static_cast<float>(step.rate[k] / extinction) : 0.0f;
        });
        return t[0];
    }
    double left = random.uniform() * sum;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < count; left -= values[i++][c]) {
        if (values[i][c] > 0) chosen = i;
        if (left < values[i][c]) break;
    }
    f = values[chosen];
    return t[chosen];
}

/// Marches one part to the first event of channel c before `event`, and replaces that. `depth`:
/// optical depths of all channels up to there, or to the ray's end. True: there was such an event.
template <int N>
bool findEvent(March<N> march, int part, int c, double u, RandomStream& random, Event<N>& event,
               Numbers<N>& depth, TrackingCounters& counters) {
    depth = {};
    double left = -std::log(u);
    Step<N> step;
    while (march.next(step, counters) && step.t0 < event.t) {
        if (left < step.depth(c, step.t1)) {
            Spectrum<N> f = step.f;
            const double t = step.exact ? step.t0 + left / step.rate[c]
                                        : placeWithin(step, march, c, random, f, counters);
            const bool first = t < event.t;
            if (first) event = {t, part, f};
            for (int k = 0; k < N; ++k) depth[k] += step.depth(k, std::min(t, event.t));
            return first;
        }
        left -= step.depth(c, step.t1);
        for (int k = 0; k < N; ++k) depth[k] += step.depth(k, std::min(step.t1, event.t));
    }
    return false;
}

/// The probability of each channel to draw the optical depth.
template <int N>
Numbers<N> channelChances(const Medium& medium, Spectrum<N> throughput) {
    Numbers<N> chances{};
    double sum = 0;
    for (int c = 0; c < N; ++c) {
        double weight = 0;
        for (const MediumPart& part : medium.parts) weight += part.channelWeight()[c];
        chances[c] = throughput[c] * weight;
        sum += chances[c];
    }
    for (int c = 0; c < N; ++c) chances[c] = sum > 0 ? chances[c] / sum : 1.0 / N;
    return chances;
}

/// Weights the throughput for an event, or for none: for each channel, the density of what happened
/// over the probability with which it was sampled.
template <int N>
Spectrum<N> weightOf(const Medium& medium, const DistanceQuery<N>& q, const Event<N>& event,
                     const Numbers<N>& chances, const Numbers<N>& depth) {
    Spectrum<N> scattered(1.0f), extinguished(1.0f);
    if (event.part >= 0) {
        const MediumPart& part = medium.parts[static_cast<std::size_t>(event.part)];
        extinguished = channels<N>(part.extinction()) * event.f;
        scattered = q.absorptionToo ? extinguished : channels<N>(part.scattering()) * event.f;
        if (part.albedo() && !q.absorptionToo)
            scattered *= albedoAt<N>(part, q.origin + q.direction * event.t, q.time, InFull{});
    }
    if constexpr (N == 1) {
        return Spectrum<N>(extinguished[0] > 0 ? scattered[0] / extinguished[0] : 0.0f);
    } else {
        double sum = 0;
        for (int c = 0; c < N; ++c) sum += chances[c] * extinguished[c] * std::exp(-depth[c]);
        return Spectrum<N>::map([&](int c) {
            return sum > 0 ? static_cast<float>(scattered[c] * std::exp(-depth[c]) / sum) : 0.0f;
        });
    }
}

/// Each part marches by a random stream of its own, so that it can be marched again.
template <int N>
void marchOne(const Medium& medium, const MarchSettings& settings, DistanceQuery<N>& q,
              std::vector<RandomStream>& streams, TrackingCounters& counters) {
    const auto chances = channelChances(medium, q.throughput);
    int c = 0;
    if constexpr (N > 1)
        for (double u = q.random.uniform(); c + 1 < N && u >= chances[c]; ++c) u -= chances[c];
    const auto march = [&](std::size_t i) {
        return March<N>(medium.parts[i], settings, q, streams[i]);
    };
    Event<N> event{q.tMax};
    Numbers<N> depth{};  // of the part where the event is
    streams.clear();
    for (std::size_t i = 0; i < medium.parts.size(); ++i) {
        streams.emplace_back(q.random.bits());
        Numbers<N> here;
        const double u = i == 0 ? q.u : q.random.uniformOpenLow();
        if (findEvent(march(i), static_cast<int>(i), c, u, q.random, event, here, counters) ||
            medium.parts.size() == 1)
            depth = here;
    }
    if (N > 1 && medium.parts.size() > 1)
        for (std::size_t i = 0; i < medium.parts.size(); ++i)
            if (static_cast<int>(i) != event.part) addDepth(march(i), event.t, depth, counters);
    q.throughput *= weightOf(medium, q, event, chances, depth);
    q.t = event.t, q.part = event.part;
}

/// The optical depth at which each channel's weight falls below roulette's threshold, or below the
/// smallest float.
template <int N>
Numbers<N> deepest(Spectrum<N> weight, const Roulette& roulette) {
    const double least = std::max(double{roulette.killBelow()}, 1e-46);
    Numbers<N> limit;
    for (int c = 0; c < N; ++c) limit[c] = std::log(weight[c] / least);
    return limit;
}

template <int N>
Spectrum<N> marchedTransmittance(const Medium& medium, const MarchSettings& settings,
                                 TransmittanceQuery<N>& q, const Numbers<N>& limit,
                                 TrackingCounters& counters) {
    Numbers<N> depth{};
    for (const MediumPart& part : medium.parts) {
        March<N> march(part, settings, q, RandomStream(q.random.bits()));
        Step<N> step;
        while (march.next(step, counters)) {
            bool lost = true;
            for (int c = 0; c < N; ++c) {
                depth[c] += step.depth(c, step.t1);
                lost &= depth[c] > limit[c];
            }
            if (lost) return {};
        }
    }
    return Spectrum<N>::map([&](int c) { return static_cast<float>(std::exp(-depth[c])); });
}

}  // namespace

void prepareMarch(const Medium& medium, const MarchSettings& settings) {
    if (!(settings.step > 0 && std::isfinite(settings.step)))
        throw usageError("march_step is {} voxels; expected a number above 0", settings.step);
    constexpr double blockDiagonal = 8 * 1.7320508075688772;
    for (const MediumPart& part : medium.parts) {
        if (part.extinctionVaries())
            throw usageError(
                "march_step cannot be used together with similarity or octaves where a volume's "
                "albedo is a grid: its extinction would change with the albedo");
        const double voxels = std::min(length(part.support().size()),
                                       part.marchCells().varyingBlocks() * blockDiagonal);
        const double least = voxels * (settings.jackknife ? 2 : 1) / mostLookUps;
        if (part.field() && settings.step < least)
            throw usageError(
                "march_step is {:.3g} voxels: a ray through {:.3g} voxels would need more than "
                "{:.0e} lookups; expected at least {:.3g}",
                settings.step, voxels, mostLookUps, least);
    }
}

template <int N>
void marchDistance(const Medium& medium, const MarchSettings& settings,
                   std::span<DistanceQuery<N>> queries, TrackingCounters& counters) {
    std::vector<RandomStream> streams;
    for (DistanceQuery<N>& q : queries) {
        q.part = -1, q.t = q.tMax;
        Roulette roulette(q.roulette, q.random);
        if (medium.parts.empty() || !(q.throughput.maximum() > 0)) continue;
        marchOne(medium, settings, q, streams, counters);
        if (q.part >= 0 &&
            (!(q.throughput.maximum() > 0) || roulette.kills(q.throughput.maximum())))
            q.throughput = {}, q.part = -1, q.t = q.tMax;
        roulette.lift(q.throughput);
    }
}

template <int N>
void marchTransmittance(const Medium& medium, const MarchSettings& settings,
                        std::span<TransmittanceQuery<N>> queries, TrackingCounters& counters) {
    for (TransmittanceQuery<N>& q : queries) {
        Roulette roulette(q.roulette, q.random);
        q.contribution *=
            marchedTransmittance(medium, settings, q, deepest(q.contribution, roulette), counters);
        if (roulette.kills(q.contribution.maximum()))
            q.contribution = {};
        else
            roulette.lift(q.contribution);
    }
}

template void marchDistance<1>(const Medium&, const MarchSettings&, std::span<DistanceQuery<1>>,
                               TrackingCounters&);
template void marchDistance<3>(const Medium&, const MarchSettings&, std::span<DistanceQuery<3>>,
                               TrackingCounters&);
template void marchTransmittance<1>(const Medium&, const MarchSettings&,
                                    std::span<TransmittanceQuery<1>>, TrackingCounters&);
template void marchTransmittance<3>(const Medium&, const MarchSettings&,
                                    std::span<TransmittanceQuery<3>>, TrackingCounters&);

}  // namespace woodcock::medium
