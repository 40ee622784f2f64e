// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_SCATTERING) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_SCATTERING
#undef WOODCOCK_LANE_SCATTERING
#else
#define WOODCOCK_LANE_SCATTERING
#endif

#include <algorithm>
#include <cmath>

#include "woodcock/render/lanes/lane_tracer-inl.h"
#include "woodcock/render/stages/light.h"
#include "woodcock/render/stages/roulette.h"
#include "woodcock/render/stages/turn.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// These paths have scattered: samples the lights there, and decides how they go on.
template <int N>
void LaneTracer<N>::arrive(std::uint32_t arrived) {
    std::uint32_t lit = 0;
    forEachLane(arrived, [&](std::size_t i) { lit |= std::uint32_t{mayGoOn(i)} << i; });
    if (scene_.radiance && scene_.cameraDepths) {
        std::uint32_t first = 0;  // they scatter where no collision was decided
        forEachLane(lit, [&](std::size_t i) {
            first |= std::uint32_t{pathOf(i).scatterings == 0 && !lanes_[i].extra} << i;
        });
        if (first) findExpected(first);
    }
    Floats growth;  // of the window's target, with the optical depth to the sun; see keepWindow()
    growth.set(all(1));
    if (scene_.sun >= 0) {
        const F depth = addSunlight(lit);
        if (scene_.thick)
            growth.set(all(1) / decay(all(0.7f) * logarithm(all(1) + all(0.25f) * depth)));
    }
    if (!scene_.others.empty())
        forEachLane(lit, [&](std::size_t i) {
            if (!lanes_[i].extra) addOtherLight(i);
        });
    forEachLane(lit, [&](std::size_t i) {
        if (lanes_[i].extra)
            endExtra(i);
        else
            goOn(i, growth[i]);
    });
}

/// False: the path ends where it has come to. Else draws the numbers that are needed there.
template <int N>
bool LaneTracer<N>::mayGoOn(std::size_t lane) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    if (!l.extra) {
        if (seen(p) && !l.fromCamera) {
            p.throughput = throughputOf(lane);
            endCameraFlight(lane, true);
        }
        if (!traced_.mayScatter(p.scatterings)) {
            endBranch(lane);
            return false;
        }
        if (several_) l.position = positionOf(lane);
    }
    ++batch_.counters.scatterings;
    const std::int64_t orders = l.fromCamera && scene_.points > 1 ? 1 : quasiRandomOrders;
    l.quasiRandom = !l.extra && l.first && p.scatterings < orders;
    EventNumbers& u = numbers_[lane];
    if (l.quasiRandom && !samplesLights_ && scene_.emission.empty()) {
        drawTurnNumbers(p, u);
    } else if (l.quasiRandom) {
        u = drawNumbers(p);
    } else if (samplesLights_) {
        u.light = {p.random.uniform(), p.random.uniform()}, u.pick = p.random.uniform();
    }
    if (traced_.media.replaces()) enterMedium(lane);
    if (!scene_.emission.empty() && !l.extra) lookForEmission(lane, &phaseOf(lane));
    if (samplesLights_)
        p.from = {positionOf(lane), directionOf(lane), &phaseOf(lane).part->phase(), p.time};
    return true;
}

/// Has a path that has scattered go on through the media that similarity chooses there. Its turn is
/// still that of the medium that has scattered it.
template <int N>
void LaneTracer<N>::enterMedium(std::size_t lane) {
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    const std::uint8_t set = traced_.media.setAfter(p.scatterings + 1);
    if (set == l.set) return;
    l.set = set, p.mediumSet = set;
    load(lane, numberOf(lane, l.part)), loadMatter(lane, numberOf(lane, l.part));
    mu_[lane] = upper_[lane] * extinction_[lane];
    perMu_[lane] = mu_[lane] > 0 ? 1 / mu_[lane] : huge;
}

/// Samples one of the lights that are not the sun of the grid.
template <int N>
void LaneTracer<N>::addOtherLight(std::size_t lane) {
    PathState<N, false>& p = pathOf(lane);
    p.throughput = throughputOf(lane);
    findProbabilities(p.from);
    const EventNumbers& numbers = numbers_[lane];
    double u = numbers.pick;
    std::size_t k = 0;
    while (k + 1 < scene_.others.size() && u >= double{probabilities_[k]})
        u -= double{probabilities_[k++]};
    if (probabilities_[k] > 0)
        addSampled(traced_, batch_, lanes_[lane].path,
                   {scene_.others[k], double{probabilities_[k]}}, numbers, FlightShare());
}

/// With which addOtherLight() chooses each of the others.
template <int N>
void LaneTracer<N>::findProbabilities(const light::ScatterPoint& from) {
    const light::LightSet& lights = traced_.scene.lights;
    const auto sampled = lights.sampled();
    picks_.resize(sampled.size());
    lights.pickProbabilities(from, picks_);
    probabilities_.clear();
    float sum = 0;
    for (std::size_t i = 0, k = 0; i < sampled.size() && k < scene_.others.size(); ++i)
        if (sampled[i] == scene_.others[k])
            probabilities_.push_back(picks_[i]), sum += picks_[i], ++k;
    for (float& p : probabilities_) p = sum > 0 ? p / sum : 0;
}

/// Has a path that has scattered draw its next direction and flight, or ends it.
template <int N>
void LaneTracer<N>::goOn(std::size_t lane, float growth) {
    PathState<N, false>& p = pathOf(lane);
    ++p.scatterings;
    scattered_[lane] = 1, share_[lane] = 1;
    if (p.scatterings >= firstOrderRoulette) {
        p.throughput = throughputOf(lane);
        if (!surviveOrder(p, false)) {
            endBranch(lane);
            return;
        }
        const float factor = p.throughput.maximum() / throughputOf(lane).maximum();
        setLane(predicted_, lane, laneOf(predicted_, lane) * factor);
        setLane(w_, lane, p.throughput);
    }
    if (scene_.thick && scene_.sun >= 0) {
        // A path's points on its camera ray share its weight.
        const auto points = static_cast<float>(lanes_[lane].fromCamera ? scene_.points : 1);
        if (!keepWindow(lane, partOf(lane).windowScale * growth / points)) {
            endBranch(lane);
            return;
        }
    }
    state_[lane] = Departing;
}

/// Splits a path whose weight is above the window around `target`, or plays Russian roulette where
/// it is below. False: it ends.
///
/// Nearly all of a sun's light comes from the few events that are near it, and deep paths bring
/// little but what all bring. So paths are kept dense near the sun: the target is their weight at
/// an optical depth d to it, s (1 + d / 4)^0.7. Of s 0.12 to 1, and of exponents 0.5 to 1, these
/// measured best (weight windows: Booth and Hendricks 1984).
///
/// A change of weight would change the light of even surroundings, which every path brings alike.
/// So what the path was about to bring on average is added for what roulette has taken, and the
/// other way round; see bringControls().
template <int N>
bool LaneTracer<N>::keepWindow(std::size_t lane, float target) {
    constexpr float above = 1.6f, below = 0.6f;
    constexpr int mostCopies = 8;
    Lane& l = lanes_[lane];
    PathState<N, false>& p = pathOf(lane);
    const Spectrum<N> w = throughputOf(lane);
    const float weight = w.maximum();
    if (weight <= above * target && weight >= below * target) return true;
    float factor = 0;
    int copies = 1;
    if (weight > target) {
        copies = std::min(mostCopies, static_cast<int>(weight / target + 0.5f));
        factor = 1 / static_cast<float>(copies);
    } else {
        const bool survives = static_cast<float>(p.random.uniform()) * target < weight;
        if (survives) factor = target / weight;
        for (int c = 0; c < N; ++c)
            chance_[c][lane] += w[c] * (factor - 1) * expectedToScatter(lane, c);
        if (!survives) return false;
    }
    setLane(w_, lane, w * factor);
    setLane(predicted_, lane, laneOf(predicted_, lane) * factor);
    if (copies == 1) return true;
    Branch& b = l.branches.emplace_back();
    take(lane, b.vertex);
    for (std::size_t i = 0; i < 3; ++i) b.direction[i] = v_[i][lane];
    b.set = l.set, b.part = l.part, b.phase = l.phase, b.scatterings = p.scatterings,
    b.copies = copies - 1, b.from = p.from;
    b.throughput = throughputOf(lane), b.predicted = laneOf(predicted_, lane);
    return true;
}

/// Draws the turns and the next flights.
template <int N>
void LaneTracer<N>::depart(Mask departing) {
    U words[4];
    draw(departing, words);
    const std::uint32_t bits = bitsOf(departing);
    Floats u0, u1, depth;
    u0.set(uniform(words[0])), u1.set(uniform(words[1])), depth.set(drawDepth(words[2]));
    forEachLane(bits, [&](std::size_t i) {
        if (!lanes_[i].quasiRandom) return;
        const EventNumbers& n = numbers_[i];
        const auto belowOne = [](double u) {
            return std::min(static_cast<float>(u), 0x1.fffffep-1f);
        };
        u0[i] = belowOne(n.phase[0]), u1[i] = belowOne(n.phase[1]);
        depth[i] = static_cast<float>(-std::log(n.flight));
    });
    F before[N];
    for (int c = 0; c < N; ++c) before[c] = g_.get() * aheadIn(c);
    turn(departing, bits, u0.get(), u1.get());
    if (scene_.radiance) noteTurn(bits, before);
    Floats more;
    for (int c = 0; c < N; ++c) gain_[c].set(departing, hn::Zero(lanesF));
    more.set(scene_.sun >= 0 ? takePrediction(departing) : hn::Zero(lanesF));
    play(departing, uniform(words[3]));
    if (scene_.controlsFlights) foresee(departing);
    if (traced_.media.replaces())
        forEachLane(bits, [&](std::size_t i) {
            lanes_[i].phase = numberOf(i, lanes_[i].part), g_[i] = phaseOf(i).g;
        });
    if (!several_) takeDirection(departing);
    const std::uint32_t alive = bitsOf(mostThroughput() > hn::Zero(lanesF));
    forEachLane(bits, [&](std::size_t i) {
        if (!(alive >> i & 1))
            endBranch(i);
        else if (more[i] > 0)
            flySeveralTimes(i, static_cast<int>(more[i]), depth[i]);
        else if (!takeOff(i, depth[i]))
            end(i, false);
    });
}

/// Turns the lanes by their phase functions.
template <int N>
void LaneTracer<N>::turn(Mask departing, std::uint32_t bits, F u0, F u1) {
    F density;
    const V3 v =
        sampleHenyeyGreenstein({v_[0].get(), v_[1].get(), v_[2].get()}, g_.get(), u0, u1, density);
    Floats turned[3], densities, numbers[2];
    turned[0].set(v.x), turned[1].set(v.y), turned[2].set(v.z), densities.set(density);
    numbers[0].set(u0), numbers[1].set(u1);
    forEachLane(bits, [&](std::size_t i) {
        if (phaseOf(i).henyeyGreenstein) return;
        PathState<N, false>& p = pathOf(i);
        p.throughput = throughputOf(i), p.direction = directionOf(i);
        const medium::PhaseSample s = render::turn(p, phaseOf(i).part->phase(),
                                                   {double{numbers[0][i]}, double{numbers[1][i]}});
        setLane(w_, i, p.throughput);
        for (int k = 0; k < 3; ++k) turned[k][i] = static_cast<float>(s.direction[k]);
        densities[i] = static_cast<float>(s.pdf);
    });
    for (int k = 0; k < 3; ++k) v_[k].set(departing, turned[k].get());
    density_.set(departing, densities.get());
}

/// Russian roulette of paths that carry little; none is left of those that end.
template <int N>
void LaneTracer<N>::play(Mask departing, F random) {
    const F survival = mostThroughput() * all(1 / pathRoulette);
    const Mask plays = hn::And(departing, survival < all(1));
    const Mask dies = random >= survival;
    for (int c = 0; c < N; ++c) {
        const F before = w_[c].get(), after = hn::IfThenZeroElse(dies, before / survival);
        if (scene_.chanceLight >= 0)
            chance_[c].set(plays,
                           chance_[c].get() + expectedWith(c, aheadIn(c)) * (after - before));
        w_[c].set(plays, after);
    }
}

/// Takes the lanes' directions to the voxels of the only part.
template <int N>
void LaneTracer<N>::takeDirection(Mask departing) {
    const LanePart& part = scene_.parts.front();
    const F x = v_[0].get(), y = v_[1].get(), z = v_[2].get();
    for (int i = 0; i < 3; ++i) {
        const float* row = part.indexFromWorld[i];
        const F d = x * all(row[0]) + y * all(row[1]) + z * all(row[2]);
        d_[i].set(departing, d);
        inverse_[i].set(departing, all(1) / hn::Max(hn::Abs(d), all(1 / huge)));
    }
    t_.set(departing, hn::Zero(lanesF));
}

/// Begins the flight from where the lane's path has turned, with this optical depth to its first
/// tentative collision. False: it leaves the medium at once.
template <int N>
bool LaneTracer<N>::takeOff(std::size_t lane, float depth) {
    if (several_) return begin(lane, lanes_[lane].position, depth);
    depth_[lane] = drawn_[lane] = depth;
    state_[lane] = Walking;
    return true;
}

// ---- several flights

/// A path has turned to where much sunlight is expected. Follows that direction several times, for
/// the light at the end of each flight: each brings an equal share, and the path goes on along its
/// own, the last. Their first optical depths are stratified.
///
/// It is the n-tuple local estimate of Buras and Mayer 2011, "Efficient unbiased variance reduction
/// techniques for Monte Carlo simulations of radiative transfer in cloudy atmospheres: The
/// solution", where it pays most.
template <int N>
void LaneTracer<N>::flySeveralTimes(std::size_t lane, int more, float depth) {
    Lane& l = lanes_[lane];
    l.extra = true, l.flights = more + 1, l.extraLeft = more, l.ownDepth = depth;
    l.ownStratum =
        std::min(more, static_cast<int>(std::exp(-depth) * static_cast<float>(l.flights)));
    share_[lane] = 1.0f / static_cast<float>(l.flights);
    take(lane, l.start);
    l.startSet = l.set, l.startPart = l.part, l.startFrom = pathOf(lane).from;
    for (std::size_t i = 0; i < 3; ++i) l.direction[i] = v_[i][lane];
    l.throughput = throughputOf(lane), l.chance = laneOf(chance_, lane);
    l.gain = laneOf(gain_, lane);
    flyAgain(lane);
}

template <int N>
void LaneTracer<N>::flyAgain(std::size_t lane) {
    Lane& l = lanes_[lane];
    for (; l.extraLeft > 0; --l.extraLeft) {
        const int stratum = l.extraLeft - (l.extraLeft <= l.ownStratum);
        const double u = (stratum + pathOf(lane).random.uniformOpenLow()) / l.flights;
        if (takeOff(lane, static_cast<float>(-std::log(u)))) return;
    }
    l.extra = false;
    if (!takeOff(lane, l.ownDepth)) end(lane, false);
}

/// One of several flights has ended: back to where they start.
template <int N>
void LaneTracer<N>::endExtra(std::size_t lane) {
    Lane& l = lanes_[lane];
    l.set = l.startSet, l.part = l.startPart;
    pathOf(lane).mediumSet = l.set, pathOf(lane).from = l.startFrom;
    put(lane, l.start);
    scatterIn(lane);
    for (std::size_t i = 0; i < 3; ++i) v_[i][lane] = l.direction[i];
    setLane(w_, lane, l.throughput), setLane(chance_, lane, l.chance);
    setLane(gain_, lane, l.gain);
    --l.extraLeft;
    flyAgain(lane);
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
