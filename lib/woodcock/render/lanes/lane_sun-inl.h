// SPDX-License-Identifier: Apache-2.0
// Compiled once for each set of instructions: see trace_lanes.cpp.
#if defined(WOODCOCK_LANE_SUN) == defined(HWY_TARGET_TOGGLE)
#ifdef WOODCOCK_LANE_SUN
#undef WOODCOCK_LANE_SUN
#else
#define WOODCOCK_LANE_SUN
#endif

#include <algorithm>

#include "woodcock/medium/corrected_transmittance.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/render/lanes/lane_tracer-inl.h"
#include "woodcock/render/light_choice.h"
#include "woodcock/render/stages/light.h"

HWY_BEFORE_NAMESPACE();
namespace woodcock::render::HWY_NAMESPACE {

/// Beyond this optical depth to the sun, the estimate of what comes through is 0, and corrections
/// are as rare as they get.
inline constexpr float deepest = 20;
/// Up to this optical depth, the next event is predicted.
inline constexpr float predictedTo = 8;
/// A path follows a direction once more for each such part of LightSet::typicalRadiance() that is
/// expected from there; at most so often. Of 0.03, 0.1 and 0.3, this measured best.
inline constexpr float worthAFlight = 0.1f;
inline constexpr float mostExtraFlights = 4;

/// Of what is expected of the next event, a flight that collides brings this much more than one
/// that goes on; see foresee(). Of 0, 0.33 and 0.5 this measured best.
inline constexpr float gainOfNextEvent = 0.33f;

/// Optical depths of the lanes' positions to the sun, as DepthGrid::Depth.
template <int N>
struct LaneTracer<N>::SunDepths {
    F depth[N], least[N], most[N];
};

template <int N>
typename LaneTracer<N>::SunDepths LaneTracer<N>::readSunDepths(std::uint32_t bits) {
    F at[3], x[3], within[3];
    for (int i = 0; i < 3; ++i)
        at[i] = hn::ConvertTo(lanesF, corner_[i].get() - low_[i].get()) + u_[i].get();
    for (int i = 0; i < 3; ++i)
        x[i] = at[0] * lattice_[i][0].get() + at[1] * lattice_[i][1].get() +
               at[2] * lattice_[i][2].get() + lattice_[i][3].get();
    if (scene_.lamp) {
        const F perDistance = all(1) / (perspective_[0].get() + x[2] * perspective_[1].get());
        x[0] = x[0] * perDistance, x[1] = x[1] * perDistance;
    }
    Ints cell[3];
    for (int i = 0; i < 3; ++i) {
        const I cells = latticeCells_[i].get();
        const F inside = hn::Max(hn::Zero(lanesF), hn::Min(hn::ConvertTo(lanesF, cells), x[i]));
        const I whole = hn::Min(hn::ConvertTo(lanesI, inside), cells - hn::Set(lanesI, 1));
        cell[i].set(whole);
        within[i] = inside - hn::ConvertTo(lanesF, whole);
    }
    const auto lerp = [](F t, F a, F b) { return a + t * (b - a); };
    SunDepths depths;
    const auto isColoured = [](const medium::DepthGrid* grid) {
        return grid && grid->channels() > 1;
    };
    const int channels = std::ranges::any_of(scene_.sunDepths, isColoured) ? N : 1;
    for (int c = 0; c < channels; ++c) {
        Floats far[4], near[4];  // of the sun
        forEachLane(bits, [&](std::size_t i) {
            const medium::DepthGrid& grid = *scene_.sunDepths[lanes_[i].set];
            const auto [alongU, alongV, alongW] = grid.strides();
            const float* n =
                grid.nodes(cell[0][i], cell[1][i], cell[2][i]) + (isColoured(&grid) ? c : 0);
            const std::size_t corners[4] = {0, alongU, alongV, alongU + alongV};
            for (std::size_t k = 0; k < 4; ++k)
                far[k][i] = n[corners[k]], near[k][i] = n[corners[k] + alongW];
        });
        F line[4];
        for (int k = 0; k < 4; ++k) line[k] = lerp(within[2], far[k].get(), near[k].get());
        depths.depth[c] =
            lerp(within[1], lerp(within[0], line[0], line[1]), lerp(within[0], line[2], line[3]));
        // Depths fall towards the sun.
        const F least = hn::Min(hn::Min(near[0].get(), near[1].get()),
                                hn::Min(near[2].get(), near[3].get())),
                most = hn::Max(hn::Max(far[0].get(), far[1].get()),
                               hn::Max(far[2].get(), far[3].get()));
        const F beside = beside_.get() * (most - least);
        depths.least[c] = hn::Max(hn::Zero(lanesF), least - beside);
        depths.most[c] = most + beside;
    }
    for (int c = N - 1; c >= 0; --c) {
        const F colour = sunColour_[c].get();
        const int from = channels == 1 ? 0 : c;
        depths.depth[c] = depths.depth[from] * colour;
        depths.least[c] = depths.least[from] * colour;
        depths.most[c] = depths.most[from] * colour;
    }
    return depths;
}

/// Where the sun is a lamp: finds where it is from the lanes' positions, and how much light comes.
template <int N>
void LaneTracer<N>::turnToLamp(std::uint32_t bits) {
    if (!scene_.lamp) return;
    forEachLane(bits, [&](std::size_t i) {
        const light::LightSample s = scene_.sunAt(positionOf(i));
        for (int k = 0; k < 3; ++k) toSun_[k][i] = static_cast<float>(s.direction[k]);
        sunScale_[i] = s.weight.maximum() / scene_.centre.weight.maximum();
    });
}

/// Henyey and Greenstein's phase function from the lanes' directions to the sun's centre.
template <int N>
F LaneTracer<N>::phaseTowardsSun(F g) const {
    const V3 s = {toSun_[0].get(), toSun_[1].get(), toSun_[2].get()};
    const V3 v = {v_[0].get(), v_[1].get(), v_[2].get()};
    const V3 apart = v - s, together = v + s;
    // Their squares are 2 (1 - cosine) and 2 (1 + cosine), without cancellation.
    const F one = all(1);
    const F d = hn::IfThenElse(g >= hn::Zero(lanesF), (one - g) * (one - g) + g * dot(apart, apart),
                               (one + g) * (one + g) - g * dot(together, together));
    return (one - g) * (one + g) / (all(static_cast<float>(4 * pi)) * d * hn::Sqrt(d));
}

/// Sunlight that arrives where nothing is in its way, from a point of the disc; times the phase
/// function, and the weight of multiple importance sampling.
template <int N>
Rgb LaneTracer<N>::sampleSun(std::size_t lane) {
    const std::array<double, 2>& u = numbers_[lane].light;
    const light::LightSample s =
        scene_.delta ? scene_.sunAt(positionOf(lane))
                     : traced_.scene.lights.sample(scene_.sun, positionOf(lane), u[0], u[1]);
    const medium::PhaseFunction& phase = phaseOf(lane).part->phase();
    const double cosine = dot(directionOf(lane), s.direction);
    Rgb light = s.weight;
    double density = phase.value(cosine);
    if constexpr (N == 3)
        if (phase.chromatic()) {
            const auto mixed = phase.mixed(cosine, toRgb(throughputOf(lane)));
            light = light * mixed.weight, density = mixed.density;
        }
    double weight = density;
    if (s.pdf > 0) weight *= powerHeuristic(s.pdf, density);
    sunDirection_[lane] = s.direction;
    return sunLight_[lane] = light * (static_cast<float>(weight) * share_[lane]);
}

/// Next-event estimation of the sun where these lanes have scattered, as correctedTransmittance()
/// has it. Returns the optical depths to the sun, of the channel that has the least.
template <int N>
F LaneTracer<N>::addSunlight(std::uint32_t lit) {
    turnToLamp(lit);
    const SunDepths depths = readSunDepths(lit);
    F least = depths.least[0], depth = depths.depth[0];
    for (int c = 1; c < N; ++c)
        least = hn::Min(least, depths.least[c]), depth = hn::Min(depth, depths.depth[c]);
    const Mask deep = least > all(deepest);
    const std::uint32_t shallow = lit & ~bitsOf(deep);
    const auto inVectors = [&](std::size_t i) {
        return scene_.delta && phaseOf(i).henyeyGreenstein;
    };
    // The largest channel of what arrives where nothing is in its way.
    Floats light;
    light.set(phaseTowardsSun(g_.get()) * all(scene_.centre.weight.maximum()) * sunScale_.get() *
              share_.get());
    forEachLane(shallow, [&](std::size_t i) {
        if (!inVectors(i)) light[i] = sampleSun(i).maximum();
    });
    F probability = all(medium::rarestCorrection);
    Floats passes[N];
    for (int c = 0; c < N; ++c) {
        passes[c].set(hn::IfThenZeroElse(deep, decay(depths.depth[c])));
        // About half of the difference of the transmittances at the nodes.
        const F unsure = decay(depths.least[c]) *
                         hn::Min(all(0.5f), all(0.5f) * (depths.most[c] - depths.least[c]));
        const F weight = w_[c].get() * light.get() * all(1 / traced_.typicalRadiance);
        probability = hn::Max(probability, hn::IfThenZeroElse(deep, weight * unsure));
    }
    predictNextEvent(lit, depths);
    U words[4];
    draw(maskOf(lit), words);
    const std::uint32_t corrected = lit & bitsOf(uniform(words[0]) < probability);
    Floats correction;
    correction.set(all(1) / hn::Min(all(1), probability));
    batch_.counters.shadowRays += static_cast<unsigned>(std::popcount(lit));
    forEachLane(shallow | corrected, [&](std::size_t i) {
        const Rgb arrives = inVectors(i)
                                ? scene_.centre.weight * (light[i] / scene_.centre.weight.maximum())
                            : shallow >> i & 1 ? sunLight_[i]
                                               : sampleSun(i);
        bringSunlight(i, arrives, laneOf(passes, i), corrected >> i & 1 ? correction[i] : 0);
    });
    return depth;
}

/// Brings light through the medium, of which `passes` is the estimate. `corrected`: 0, or one over
/// the probability of a correction.
template <int N>
void LaneTracer<N>::bringSunlight(std::size_t lane, Rgb light, Spectrum<N> passes,
                                  float corrected) {
    if (!(light.maximum() > 0)) return;
    if (corrected > 0) {
        const Vec3d towards =
            scene_.delta ? scene_.sunAt(positionOf(lane)).direction : sunDirection_[lane];
        medium::TrackingCounters counters;
        const Spectrum<N> exact = medium::exactTransmittance<N>(
            traced_.mediumOfSet(lanes_[lane].set), positionOf(lane), towards, counters);
        batch_.counters.shadowSegments += counters.segments;
        passes = passes + (exact - passes) * corrected;
    }
    PathState<N, false>& p = pathOf(lane);
    bring(batch_, p, light * toRgb(throughputOf(lane) * passes), kindOfLight(p, 1),
          traced_.scene.lights.group(scene_.sun));
}

/// A control variate on the direction in which a path goes on: what its next event is expected to
/// bring is added now for all directions, and takePrediction() subtracts it for the one that was
/// drawn. A path that turns towards the sun, at optical depth d, brings E phase(0) integral of
/// exp(-t) exp(-(d - t)) dt = E phase(0) d exp(-d) by its next event; other directions, in
/// proportion to the phase function. Its mean over the directions of a Henyey-Greenstein function g
/// is the function of g^2, as their convolution is one of the product. So the mean of both together
/// is zero, whatever is expected.
template <int N>
void LaneTracer<N>::predictNextEvent(std::uint32_t lit, const SunDepths& depths) {
    std::uint32_t bits = 0;
    forEachLane(lit, [&](std::size_t i) {
        const bool predicts = !lanes_[i].extra && phaseOf(i).henyeyGreenstein &&
                              traced_.mayScatter(pathOf(i).scatterings + 1);
        bits |= std::uint32_t{predicts} << i;
    });
    const Mask predicts = maskOf(bits);
    const F scale = sunScale_.get();
    const F phase = phaseTowardsSun(g_.get() * g_.get());
    for (int c = 0; c < N; ++c) {
        const F depth = depths.depth[c];
        const F expected =
            hn::IfThenElseZero(depth < all(predictedTo),
                               w_[c].get() * albedo_[c].get() * scale * depth * decay(depth));
        predicted_[c].set(predicts, expected);
        prediction_[c].set(predicts, prediction_[c].get() + expected * phase);
    }
}

/// Subtracts what the next event was expected to bring, as the directions are drawn now. Returns
/// how many flights more to follow them for.
template <int N>
F LaneTracer<N>::takePrediction(Mask departing) {
    const F phase = phaseTowardsSun(g_.get());
    F most = hn::Zero(lanesF);
    for (int c = 0; c < N; ++c) {
        const F expected = predicted_[c].get() * phase;
        prediction_[c].set(departing, prediction_[c].get() - expected);
        predicted_[c].set(departing, hn::Zero(lanesF));  // the next event need not predict
        gain_[c].set(departing, expected * all(gainOfNextEvent * scene_.sunPerUnit[c]));
        most = hn::Max(most, expected);
    }
    const float flightsPerLight =
        scene_.centre.weight.maximum() / (worthAFlight * traced_.typicalRadiance);
    return hn::Floor(hn::Min(all(mostExtraFlights), most * all(flightsPerLight)));
}

}  // namespace woodcock::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
