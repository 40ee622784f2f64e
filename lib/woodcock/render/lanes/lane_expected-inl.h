// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_EXPECTED) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_EXPECTED
#undef WOODCOCK_LANE_EXPECTED
#else
#define WOODCOCK_LANE_EXPECTED
#endif

#include "woodcock/render/lanes/lane_tracer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

// A path is expected to bring some of the light from far away, which RadianceLattice tells roughly.
// What chance then decides makes the path bring more or less than it was expected to. That
// difference has a mean of zero, whatever is expected. So it is taken off: LaneTracer::chance_ sums
// it up.

/// Of what is expected of a turn, this much is taken off. 0.5 and 0.75 measured alike, and better
/// than 1: two moments make too much of directions near the medium's surface.
inline constexpr float expectedOfTurns = 0.75f;

/// Reads RadianceLattice at the positions of these lanes.
template <int N>
HWY_NOINLINE void LaneTracer<N>::findExpected(std::uint32_t bits) {
    const Vec3i cells = scene_.radiance->cells();
    F at[3], within[3];
    for (int i = 0; i < 3; ++i)
        at[i] = hn::ConvertTo(lanesF, corner_[i].get() - low_[i].get()) + u_[i].get();
    I number = hn::Zero(lanesI);
    for (int i = 2; i >= 0; --i) {
        const F x = at[0] * cells_[i][0].get() + at[1] * cells_[i][1].get() +
                    at[2] * cells_[i][2].get() + cells_[i][3].get();
        const F last = all(static_cast<float>(cells[i] - 1));
        const I cell = hn::ConvertTo(lanesI, hn::Max(hn::Zero(lanesF), hn::Min(x, last)));
        within[i] = x - hn::ConvertTo(lanesF, cell) - all(0.5f);
        number = number * hn::Set(lanesI, cells[i]) + cell;
    }
    // Lanes that are not asked for have some cell, too.
    constexpr int floats = sizeof(RadianceLattice::Cell) / sizeof(float);
    const float* content = &scene_.radiance->content()->channels[0].phi;
    I next = number * hn::Set(lanesI, floats);
    const auto read = [&] {
        const F value = hn::GatherIndex(lanesF, content, next);
        next = next + hn::Set(lanesI, 1);
        return value;
    };
    const Mask where = maskOf(bits);
    for (int c = 0; c < N; ++c) {
        F here = read();
        for (int k = 0; k < 3; ++k) {
            const F slope = read();
            expectedSlope_[c][k].set(where, slope);
            here = here + within[k] * slope;
        }
        for (int k = 0; k < 3; ++k) expectedAhead_[c][k].set(where, read());
        expected_[c].set(where, here), expectedSun_[c].set(where, read());
    }
}

/// By how much more is expected of paths that go in the lanes' directions than of those that go
/// anywhere. Of paths that scatter from there by a phase function of mean cosine g it is g times as
/// much.
template <int N>
HWY_INLINE F LaneTracer<N>::aheadIn(int c) const {
    return v_[0].get() * expectedAhead_[c][0].get() + v_[1].get() * expectedAhead_[c][1].get() +
           v_[2].get() * expectedAhead_[c][2].get();
}

/// What is expected in all, given how much `more` it is than of paths that go anywhere.
template <int N>
HWY_INLINE F LaneTracer<N>::expectedWith(int c, F more) const {
    return hn::Max(hn::Zero(lanesF), expected_[c].get() + more);
}

/// What is expected of a lane that has scattered and is to turn.
template <int N>
float LaneTracer<N>::expectedToScatter(std::size_t lane, int c) {
    float ahead = 0;
    for (std::size_t k = 0; k < 3; ++k) ahead += v_[k][lane] * expectedAhead_[c][k][lane];
    return std::max(0.0f, expected_[c][lane] + g_[lane] * ahead);
}

/// Takes off what turns bring too much by their directions, given how much more was expected of
/// them. Only of those that are drawn by Henyey and Greenstein's phase function, whose mean cosine
/// is g in every channel.
template <int N>
void LaneTracer<N>::noteTurn(std::uint32_t turned, const F before[N]) {
    std::uint32_t bits = 0;
    forEachLane(turned,
                [&](std::size_t i) { bits |= std::uint32_t{phaseOf(i).henyeyGreenstein} << i; });
    const Mask known = maskOf(bits);
    for (int c = 0; c < N; ++c) {
        const F more = all(expectedOfTurns) * (aheadIn(c) - before[c]);
        chance_[c].set(known, chance_[c].get() + w_[c].get() * more);
    }
}

/// Adds to gain_, for the flights ahead of these lanes, what is expected of the light that changes
/// little. Sunlight at their ends is in it already, see takePrediction().
///
/// A path that flies on to where more light comes from brings more than one that collides: by the
/// equation of transfer, sigma_t L - sigma_s J is the growth of the radiance L along the ray, where
/// J is what scatters into it. So a tentative collision has a gain of -growth / majorant. Tentative
/// collisions come once for each optical depth of the majorant, on average. So gain x (collisions -
/// depth) has a mean of zero at the end of a flight, whatever gain is, if only it is known before
/// the flight is drawn (a compensated Poisson process). noteFlight() and noteLeaving() take it off.
template <int N>
HWY_INLINE void LaneTracer<N>::foresee(Mask flying) {
    // Cells are too coarse to tell where a thin one has its light from.
    const F depth = hn::Max(all(1), mu_.get() * all(static_cast<float>(scene_.radiance->edge())));
    for (int c = 0; c < N; ++c) {
        const Floats* slope = expectedSlope_[c];
        const F growth = v_[0].get() * slope[0].get() + v_[1].get() * slope[1].get() +
                         v_[2].get() * slope[2].get();
        gain_[c].set(flying, gain_[c].get() - w_[c].get() * growth / depth);
    }
}

/// Takes off what flights bring too much that have come to a tentative collision where they did.
template <int N>
HWY_INLINE void LaneTracer<N>::noteFlight(Mask colliding) {
    const F more = all(1) - drawn_.get();
    for (int c = 0; c < N; ++c) chance_[c].set(colliding, chance_[c].get() + gain_[c].get() * more);
}

/// The same of a flight that has left the medium.
template <int N>
void LaneTracer<N>::noteLeaving(std::size_t lane) {
    for (int c = 0; c < N; ++c) chance_[c][lane] -= gain_[c][lane] * (drawn_[lane] - depth_[lane]);
}

/// The phase function of the sunlight that a collision brings where it scatters.
template <int N>
F LaneTracer<N>::phaseOfNextEvent() const {
    return phaseTowardsSun(hn::Min(g_.get(), all(RadianceLattice::mostPeaked)));
}

/// Takes off what tentative collisions bring too much by being decided as they were, given the
/// shares of what scatters and what goes on, the throughput afterwards, and phaseOfNextEvent().
template <int N>
HWY_NOINLINE void LaneTracer<N>::noteDecision(int c, Mask colliding, Mask scatters, F scattering,
                                              F null, F after, F phase) {
    const F ahead = aheadIn(c);
    const F others = expectedWith(c, ahead);
    const F scattered = expectedWith(c, g_.get() * ahead) + phase * expectedSun_[c].get();
    chance_[c].set(colliding, chance_[c].get() +
                                  after * hn::IfThenElse(scatters, scattered, others) -
                                  w_[c].get() * (scattering * scattered + null * others));
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
