// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_COLLISIONS) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_COLLISIONS
#undef WOODCOCK_LANE_COLLISIONS
#else
#define WOODCOCK_LANE_COLLISIONS
#endif

#include "woodcock/render/lanes/lane_tracer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// Decides all tentative collisions.
template <int N>
HWY_INLINE void LaneTracer<N>::decideCollisions() {
    const Mask colliding = whoIs(Colliding);
    const std::uint32_t bits = bitsOf(colliding);
    U words[4];
    draw(colliding, words);
    F f[N];
    lookUp(bits, words, f);
    const Mask scatters = decide(colliding, f, uniform(words[2]));
    const Mask alive = hn::And(colliding, mostThroughput() > hn::Zero(lanesF));
    const Mask nulls = hn::AndNot(scatters, alive);
    if (traced_.options.stoppedLight)
        forEachLane(bits, [&](std::size_t i) { noteCollision(i, !(bitsOf(nulls) >> i & 1)); });
    depth_.set(nulls, drawDepth(words[3]));
    if (scene_.controlsFlights) {
        drawn_.set(nulls, depth_.get());
        for (int c = 0; c < N; ++c) gain_[c].set(nulls, hn::Zero(lanesF));
        foresee(nulls);
    }
    state_.set(ofInts(nulls), hn::Set(lanesI, Walking));
    state_.set(ofInts(hn::And(alive, scatters)), hn::Set(lanesI, Arrived));
    if (several_)
        forEachLane(bitsOf(nulls), [&](std::size_t i) {
            Lane& l = lanes_[i];
            take(i, l.processes[l.part]);
            l.processes[l.part].waits = false;
            l.part = none;
            goOnWithNextPart(i);
        });
    forEachLane(bitsOf(hn::AndNot(alive, colliding)), [&](std::size_t i) { end(i, true); });
}

/// Which tentative collisions scatter, where the field is f; the others are null. Weights the
/// throughput. See collide() in tracking.cpp: absorption is a weight, and one decision serves all
/// channels.
template <int N>
HWY_INLINE Mask LaneTracer<N>::decide(Mask colliding, const F f[N], F random) {
    const F mu = mu_.get(), zero = hn::Zero(lanesF), one = all(1);
    const Mask counts =
        scene_.controlsCameraFlights ? colliding : hn::And(colliding, scattered_.get() > zero);
    F phase = zero;
    if (scene_.controlsFlights) noteFlight(hn::And(colliding, scattered_.get() > zero));
    if (scene_.radiance) findExpected(bitsOf(colliding)), phase = phaseOfNextEvent();
    if constexpr (N == 1) {
        const F absorption = absorption_[0].get() * f[0], left = mu - absorption;
        const F scattering = scattering_[0].get() * f[0], passes = one - absorption / mu;
        const F after = hn::IfThenElseZero(left > zero, w_[0].get() * passes);
        const Mask scatters = random * left < scattering;
        if (scene_.radiance) {
            const F share = hn::Min(passes, scattering / mu);
            noteDecision(0, counts, scatters, share, passes - share, after, phase);
        }
        w_[0].set(colliding, after);
        return scatters;
    } else {
        F scattering[N], null[N], scatterWeight = zero, weight = zero;
        for (int c = 0; c < N; ++c) {
            scattering[c] = scattering_[c].get() * f[c];
            null[c] = hn::Max(zero, mu - absorption_[c].get() * f[c] - scattering[c]);
            const F both = scattering[c] + null[c], w = w_[c].get() * channelWeight_[c].get();
            scatterWeight =
                scatterWeight + hn::IfThenElseZero(both > zero, w * (scattering[c] / both));
            weight = weight + w;
        }
        const F p = hn::IfThenElseZero(weight > zero, scatterWeight / weight);
        const Mask scatters = random < p;
        const F inverse = one / (mu * hn::IfThenElse(scatters, p, one - p));
        for (int c = 0; c < N; ++c) {
            const F after =
                w_[c].get() * hn::IfThenElse(scatters, scattering[c], null[c]) * inverse;
            if (scene_.radiance)
                noteDecision(c, counts, scatters, scattering[c] / mu, null[c] / mu, after, phase);
            w_[c].set(colliding, after);
        }
        return scatters;
    }
}

/// The field at the lanes' positions, by one-tap stochastic interpolation.
template <int N>
HWY_INLINE void LaneTracer<N>::lookUp(std::uint32_t bits, const U words[4], F f[N]) {
    // 21 bits of two words for each axis, as in Field::stochasticVoxel().
    const U ends = hn::Or(hn::ShiftLeft<10>(hn::And(words[0], hn::Set(lanesU, 0x7ffu))),
                          hn::And(words[1], hn::Set(lanesU, 0x3ffu)));
    const U parts[3] = {hn::ShiftRight<11>(words[0]), hn::ShiftRight<11>(words[1]), ends};
    Ints voxel[3];
    for (int i = 0; i < 3; ++i) {
        const F number = hn::ConvertTo(lanesF, hn::BitCast(lanesI, parts[i]));
        const F jitter = number * jitterUnit_.get() + firstJitter_.get();
        voxel[i].set(corner_[i].get() + hn::ConvertTo(lanesI, u_[i].get() + jitter));
    }
    Floats values[N];
    for (int c = 0; c < N; ++c) values[c].set(upper_.get());
    forEachLane(bits, [&](std::size_t i) {
        if (lower_[i] == upper_[i]) return;  // it is known
        const grid::Field& field = *partOf(i).part->field();
        const Vec3i at{voxel[0][i], voxel[1][i], voxel[2][i]};
        if (N == 1 || field.channels() == 1)
            setLane(values, i, Spectrum<N>(field.voxel(at)));
        else
            setLane(values, i, Spectrum<N>::map([&](int c) { return field.voxel(at, c); }));
    });
    for (int c = 0; c < N; ++c) f[c] = values[c].get();
}

/// Notes what a collision of the camera's flight has left, where that is asked for.
template <int N>
void LaneTracer<N>::noteCollision(std::size_t lane, bool ends) {
    if (auto* noted = collisionsOf(lane))
        noted->push_back({lanes_[lane].flightStart + double{t_[lane]},
                          static_cast<int>(lanes_[lane].part),
                          ends ? 0 : throughputOf(lane).mean()});
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
