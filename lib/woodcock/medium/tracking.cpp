// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/tracking.h"

#include <algorithm>

#include "woodcock/medium/look_up.h"
#include "woodcock/medium/refined_walk.h"
#include "woodcock/medium/roulette.h"

namespace woodcock::medium {

namespace {

/// f (times albedo, for scattering) at one point, by one-tap stochastic interpolation: every weight
/// below is linear in it, so its noise does not cause bias.
template <int N>
struct Sampled {
    Spectrum<N> f, albedo;
};

/// f at an index position, by full interpolation inside tight bounds. Not inline: both loops have
/// more registers without it.
template <int N>
[[gnu::noinline]] Spectrum<N> density(const MediumPart& part, Vec3d index, float time, bool tight,
                                      std::uint64_t bits) {
    if (tight) return densityAt<N>(part, index, time, InFull{});
    return densityAt<N>(part, index, time, OneTap{bits});
}

/// The field's value at a tentative collision at `t`. Where the two bounds are equal, f is known
/// without a lookup.
template <int N>
Sampled<N> sampleAt(DistanceQuery<N>& q, const MediumPart& part, const grid::IndexRay& ray,
                    double t, grid::Range range, bool tight) {
    Sampled<N> s{Spectrum<N>(range.max), Spectrum<N>(1.0f)};
    if (range.min != range.max) s.f = density<N>(part, ray.at(t), q.time, tight, q.random.bits());
    if (part.albedo())
        s.albedo = albedoAt<N>(part, q.origin + q.direction * t, q.time, OneTap{q.random.bits()});
    return s;
}

/// Decides whether a tentative collision at rate `mu` scatters or is a null collision, and weights
/// the throughput. True: it scatters.
///
/// Absorption is a weight, so channel c by itself would scatter with q_c = sigma_s,c / (sigma_s,c +
/// sigma_n,c). One decision serves all channels: by the average of q with the throughput as
/// weights. The throughput is the ratio of a channel's path density to that average. So this is the
/// single-sample balance heuristic over channels of Miller et al. 2019 (eq. 13), event by event
/// (the history-aware probabilities of Kutz et al. 2017, sec. 5.1). A factor 0.05 + albedo^2
/// favours the channels that will scatter again; it halves the grey variance of a chromatic cloud.
/// It is positive, so every channel is sampled.
template <int N>
bool collide(const MediumPart& part, const Sampled<N>& s, float mu, bool absorptionToo,
             double random, Spectrum<N>& throughput) {
    Spectrum<N> scattering = channels<N>(part.scattering()) * s.f * s.albedo;
    Spectrum<N> absorption = channels<N>(part.absorption()) * s.f;
    if (part.albedo())
        absorption +=
            channels<N>(part.scattering()) * s.f * (Spectrum<N>(1.0f) - s.albedo) * part.loss();
    if (absorptionToo) scattering += absorption, absorption = {};
    if constexpr (N == 1) {
        const float left = mu - absorption[0];  // sigma_s + sigma_n
        if (!(left > 0)) {
            throughput = {};
            return false;
        }
        throughput[0] *= 1 - absorption[0] / mu;  // exactly 1 without absorption
        return random * left < scattering[0];
    } else {
        float scatterWeight = 0, weight = 0;
        Spectrum<N> null;
        for (int c = 0; c < N; ++c) {
            null[c] = std::max(mu - absorption[c] - scattering[c], 0.0f);
            const float both = scattering[c] + null[c];
            const float w = throughput[c] * part.channelWeight()[c];
            if (both > 0) scatterWeight += w * (scattering[c] / both);
            weight += w;
        }
        const double p = weight > 0 ? double{scatterWeight} / weight : 0;
        const bool scatters = random < p;
        throughput *= scatters ? scattering * static_cast<float>(1 / (mu * p))
                               : null * static_cast<float>(1 / (mu * (1 - p)));
        return scatters;
    }
}

/// The bits of channels that still carry energy: see RefinedWalk::setLive().
template <int N>
unsigned liveChannels(Spectrum<N> weight) {
    if constexpr (N == 1) return 7;
    unsigned live = 0;
    for (int c = 0; c < N; ++c) live |= unsigned{weight[c] > 0} << c;
    return live;
}

/// The tentative collisions of one part along a ray: a Poisson process with the majorant as its
/// rate. The remaining optical depth is carried from cell to cell, so each collision costs one
/// random number.
class CollisionProcess {
public:
    template <int N>
    CollisionProcess(const MediumPart& part, int index, const DistanceQuery<N>& q, double u)
        : part_(&part),
          index_(index),
          ray_(part.indexRay(q.origin, q.direction, q.time)),
          walk_(part, ray_, q.tMax, q.time),
          depth_(-std::log(u)) {
        walk_.setLive(part, liveChannels<N>(q.throughput));
    }

    const MediumPart& part() const { return *part_; }
    int index() const { return index_; }
    const grid::IndexRay& ray() const { return ray_; }
    double t() const { return t_; }
    float mu() const { return mu_; }
    grid::Range range() const { return segment_.range; }
    bool tight() const { return walk_.tight(); }

    /// To be called after a null collision that left these channels.
    template <int N>
    void redraw(double u, Spectrum<N> throughput) {
        waiting_ = false;
        depth_ = -std::log(u);
        walk_.setLive(*part_, liveChannels<N>(throughput));
        walk_.collided(*part_, ray_, t_, segment_);
        mu_ = segment_.range.max * walk_.extinction();
    }

    /// Goes on to the next collision before `limit`, unless it is at one that was not yet handled.
    /// True when it is at a collision, at t(). Otherwise the walk pauses at `limit` or has ended;
    /// it can be called again with a larger limit.
    bool advance(double limit, TrackingCounters& counters) {
        while (!waiting_) {
            const double end = std::min(segment_.t1, limit);
            const double step = mu_ > 0 ? depth_ / mu_ : std::numeric_limits<double>::infinity();
            if (t_ + step < end) {
                t_ += step;
                ++counters.collisions;
                waiting_ = true;
                break;
            }
            if (mu_ > 0 && end > t_) depth_ = std::max(0.0, depth_ - (end - t_) * mu_);
            t_ = std::max(t_, end);
            if (segment_.t1 > limit) return false;
            if (ended_ || !walk_.next(*part_, ray_, segment_)) {
                ended_ = true, mu_ = 0, segment_.t1 = std::numeric_limits<double>::infinity();
                return false;
            }
            ++counters.segments;
            t_ = segment_.t0;
            mu_ = segment_.range.max * walk_.extinction();
        }
        return true;
    }

private:
    const MediumPart* part_;
    int index_;
    grid::IndexRay ray_;
    RefinedWalk walk_;
    grid::Segment segment_{0, 0, {}};
    float mu_ = 0;
    double t_ = 0, depth_;
    bool waiting_ = false, ended_ = false;
};

/// Notes what the collision at which `process` is has left.
template <int N>
void note(const DistanceQuery<N>& q, const CollisionProcess& process, const Roulette& roulette,
          bool scatters) {
    Spectrum<N> left = scatters ? Spectrum<N>() : q.throughput;
    roulette.lift(left);
    q.collisions->push_back({process.t(), process.index(), left.mean()});
}

/// Handles the collision at which `process` is; true when the query is decided.
/// Noted: for q.collisions.
template <int N, bool Noted>
bool settle(DistanceQuery<N>& q, CollisionProcess& process, Roulette& roulette) {
    const auto s =
        sampleAt(q, process.part(), process.ray(), process.t(), process.range(), process.tight());
    const bool scatters = collide<N>(process.part(), s, process.mu(), q.absorptionToo,
                                     q.random.uniform(), q.throughput);
    if (!(q.throughput.maximum() > 0) || roulette.kills(q.throughput.maximum())) {
        q.throughput = {};
        if constexpr (Noted) note(q, process, roulette, true);
        return true;
    }
    if constexpr (Noted) note(q, process, roulette, scatters);
    if (scatters) {
        q.t = process.t(), q.part = process.index();
        return true;
    }
    process.redraw(q.random.uniformOpenLow(), q.throughput);
    return false;
}

Vec3d inverseOf(Vec3d v) { return {1 / v.x, 1 / v.y, 1 / v.z}; }

/// Overlapping media are independent Poisson processes that superpose (Kingman 1993, sec. 2.2).
/// Each part finds its next collision among its own cells, and the nearest one happens. No part
/// looks further than the nearest collision found so far.
template <int N, bool Noted>
void trackParts(const Medium& medium, DistanceQuery<N>& q, Roulette& roulette,
                std::vector<CollisionProcess>& processes, TrackingCounters& counters) {
    processes.clear();
    const Vec3d inverse = inverseOf(q.direction);
    for (std::size_t i = 0; i < medium.parts.size(); ++i) {
        const double u =
            i == 0 ? q.u : q.random.uniformOpenLow();  // also for parts that the ray misses
        if (medium.parts[i].mayMeet(q.origin, inverse, q.tMax))
            processes.emplace_back(medium.parts[i], static_cast<int>(i), q, u);
    }
    while (true) {
        CollisionProcess* nearest = nullptr;
        double limit = q.tMax;
        for (CollisionProcess& process : processes)
            if (process.advance(limit, counters) && process.t() < limit)
                nearest = &process, limit = process.t();
        if (!nearest || settle<N, Noted>(q, *nearest, roulette)) return;
    }
}

/// By which factor to raise the rate of collisions above the least possible one, for a shadow ray
/// of this weight. More collisions, each of less weight, estimate the same transmittance with less
/// variance. Rays that will soon meet Russian roulette are not worth them. Any rate above the least
/// is unbiased, as it depends only on the ray's past. Of 1, 2, 4 and 8 as the largest factor, 4
/// measured best: on an optically thin cloud the cost (time x variance) falls to 0.58 of that at 1.
double effort(float weight, float roulette) {
    return roulette > 0 ? std::clamp(0.5f * weight / roulette, 1.0f, 4.0f) : 1.0f;
}

/// exp() of minus this is zero as a float.
constexpr double vanished = 104;

/// sigma_t over f x part.extinction(), for this albedo.
template <int N>
Spectrum<N> relativeExtinction(const MediumPart& part, const Spectrum<N>& albedo) {
    return Spectrum<N>::map([&](int c) {
        const float lost = albedo[c] + part.loss() * (1 - albedo[c]);
        const float bound = part.extinction()[c];
        return bound > 0 ? (part.absorption()[c] + part.scattering()[c] * lost) / bound : 0.0f;
    });
}

/// Multiplies q.contribution by an estimate of one part's transmittance; false once roulette ends
/// it. Varies: part.extinctionVaries(); then f's lower bound is not one of sigma_t. (Such parts
/// have fields.) Noted: for q.depthAlong, as part number `index`.
template <int N, bool Varies, bool Noted>
bool trackPart(const MediumPart& part, int index, TransmittanceQuery<N>& q, Roulette& roulette,
               TrackingCounters& counters) {
    const grid::IndexRay ray = part.indexRay(q.origin, q.direction, q.time);
    const Spectrum<N> extinction = channels<N>(part.extinction());
    RefinedWalk walk(part, ray, q.tMax, q.time);
    grid::Segment s{0, 0, {}};
    Spectrum<N> ratio = q.contribution;
    const auto least = [&] { return Varies ? 0.0f : s.range.min; };
    double control = 0;  // integral of the lower bound
    double depth = -std::log(q.random.uniformOpenLow());
    const auto arrived = [&] {
        return Spectrum<N>::map([&](int c) {
            return extinction[c] > 0 && control > 0
                       ? ratio[c] * std::exp(static_cast<float>(-control * extinction[c]))
                       : ratio[c];
        });
    };
    const auto spent = [&] {
        const float weight = arrived().maximum();
        return roulette.kills(weight) || !(weight > 0);
    };
    // 1 - the share of q.contribution that is left, where the control's integral is this.
    const auto opacityAt = [&](double controlHere) {
        return Spectrum<N>::map([&](int c) {
            const float left = q.contribution[c] > 0 ? ratio[c] / q.contribution[c] : 0.0f;
            return (1 - left) - left * std::expm1(static_cast<float>(-controlHere) * extinction[c]);
        });
    };
    const auto note = [&](double t, double controlHere) {
        if constexpr (Noted)
            q.depthAlong->push_back({t, index, Rgb::map([&](int rgb) {
                                         const int c = N == 1 ? 0 : rgb;
                                         if (!(q.contribution[c] > 0)) return 0.0f;
                                         const float left = ratio[c] / q.contribution[c];
                                         return static_cast<float>(controlHere * extinction[c] -
                                                                   std::log(double{left}));
                                     })});
    };
    // Of a segment without end, a piece that lets nothing through.
    const auto noteEnd = [&] {
        if constexpr (Noted) {
            double end = s.t1;
            if (!std::isfinite(end)) {
                float smallest = std::numeric_limits<float>::infinity();
                for (int c = 0; c < N; ++c)
                    if (extinction[c] > 0) smallest = std::min(smallest, extinction[c]);
                end = s.t0 + vanished / (double{smallest} * s.range.min);
            }
            note(end, control + (end - s.t0) * s.range.min);
        }
    };
    const auto next = [&] {
        if constexpr (N > 1)
            walk.setLive(part, liveChannels<N>(Spectrum<N>::map([&](int c) {
                             return control * extinction[c] < vanished ? ratio[c] : 0.0f;
                         })));
        return walk.next(part, ray, s);
    };
    while (next()) {
        ++counters.segments;
        const auto rateNow = [&] {
            const double width = s.range.max - least();
            if (!(width > 0)) return 0.0;
            return width * walk.extinction() * effort(arrived().maximum(), q.roulette);
        };
        double rate = rateNow();
        double t = s.t0;
        note(t, control);
        while (depth < (s.t1 - t) * rate) {
            ++counters.collisions;
            t += depth / rate;
            note(t, control + (t - s.t0) * least());
            Spectrum<N> f = density<N>(part, ray.at(t), q.time, walk.tight(), q.random.bits());
            if constexpr (Varies)
                f *= relativeExtinction<N>(part, albedoAt<N>(part, q.origin + q.direction * t,
                                                             q.time, OneTap{q.random.bits()}));
            for (int c = 0; c < N; ++c)
                ratio[c] *=
                    std::max(0.0f, 1 - (f[c] - least()) * extinction[c] / static_cast<float>(rate));
            const double controlled = (t - s.t0) * least();
            note(t, control + controlled);
            if (spent()) return false;
            depth = -std::log(q.random.uniformOpenLow());
            if constexpr (N > 1) walk.setLive(part, liveChannels<N>(arrived()));
            const bool cut = walk.collided(part, ray, t, s);
            if (cut) control += controlled;
            if (N > 1 || cut) rate = rateNow();
        }
        if (rate > 0) depth -= (s.t1 - t) * rate;
        if (least() > 0) {
            noteEnd();
            control += (s.t1 - s.t0) * least();
            if (spent()) return false;
        }
    }
    if (q.opacityToo) {
        const Spectrum<N> here = opacityAt(control);
        q.opacity =
            Spectrum<N>::map([&](int c) { return q.opacity[c] + (1 - q.opacity[c]) * here[c]; });
    }
    q.contribution = arrived();
    return true;
}

template <int N>
bool trackPart(const MediumPart& part, int index, TransmittanceQuery<N>& q, Roulette& roulette,
               TrackingCounters& counters) {
    if (q.depthAlong)
        return part.extinctionVaries()
                   ? trackPart<N, true, true>(part, index, q, roulette, counters)
                   : trackPart<N, false, true>(part, index, q, roulette, counters);
    return part.extinctionVaries() ? trackPart<N, true, false>(part, index, q, roulette, counters)
                                   : trackPart<N, false, false>(part, index, q, roulette, counters);
}

}  // namespace

template <int N>
void trackDistance(const Medium& medium, std::span<DistanceQuery<N>> queries,
                   TrackingCounters& counters) {
    std::vector<CollisionProcess> processes;
    for (DistanceQuery<N>& q : queries) {
        q.part = -1, q.t = q.tMax;
        Roulette roulette(q.roulette, q.random);
        if (q.collisions)
            trackParts<N, true>(medium, q, roulette, processes, counters);
        else
            trackParts<N, false>(medium, q, roulette, processes, counters);
        roulette.lift(q.throughput);
    }
}

template <int N>
void trackTransmittance(const Medium& medium, std::span<TransmittanceQuery<N>> queries,
                        TrackingCounters& counters) {
    for (TransmittanceQuery<N>& q : queries) {
        Roulette roulette(q.roulette, q.random);
        bool alive = !roulette.kills(q.contribution.maximum());
        const bool several = medium.parts.size() > 1;
        const Vec3d inverse = several ? inverseOf(q.direction) : Vec3d{};
        // Noted optical depths are those of all parts, also where one lets nothing through.
        for (std::size_t i = 0; (alive || q.depthAlong) && i < medium.parts.size(); ++i) {
            if (several && !medium.parts[i].mayMeet(q.origin, inverse, q.tMax))
                q.random.bits();  // keeps the stream as trackPart() would leave it
            else
                alive &= trackPart<N>(medium.parts[i], static_cast<int>(i), q, roulette, counters);
        }
        if (alive)
            roulette.lift(q.contribution);
        else
            q.contribution = {};
    }
}

template void trackDistance<1>(const Medium&, std::span<DistanceQuery<1>>, TrackingCounters&);
template void trackDistance<3>(const Medium&, std::span<DistanceQuery<3>>, TrackingCounters&);
template void trackTransmittance<1>(const Medium&, std::span<TransmittanceQuery<1>>,
                                    TrackingCounters&);
template void trackTransmittance<3>(const Medium&, std::span<TransmittanceQuery<3>>,
                                    TrackingCounters&);

}  // namespace woodcock::medium
