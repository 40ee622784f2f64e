// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/light.h"

#include <cmath>

#include "woodcock/medium/corrected_transmittance.h"
#include "woodcock/medium/phase.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/roulette.h"

namespace woodcock::render {

namespace {

/// The density with which the path's last scattering would have sampled a direction at this cosine.
/// Multiplies `light` by the phase function over it: no change but in colour.
template <int N, bool Surfaces>
double phaseDensity(const PathState<N, Surfaces>& p, double cosine, Rgb& light) {
    if constexpr (N == 3)
        if (p.from.phase->chromatic()) {
            const auto mixed = p.from.phase->mixed(cosine, toRgb(p.throughput));
            light = light * mixed.weight;
            return mixed.density;
        }
    return p.from.phase->value(cosine);
}

/// Adds the light of a sun whose optical depth is in a grid, where no surface can be in its way.
template <int N, bool Surfaces>
void bringSunlight(const TracedScene& traced, Batch<N, Surfaces>& batch, PathState<N, Surfaces>& p,
                   const medium::DepthGrid& depths, Vec3d direction, Rgb light,
                   image::LightGroup group) {
    const float brightest = light.maximum();
    const Spectrum<N> contribution = p.throughput * brightest;
    if (!(contribution.maximum() > 0)) return;
    ++batch.counters.shadowRays;
    RandomStream random(p.random.bits());  // as a shadow ray has
    medium::TrackingCounters c;
    const Spectrum<N> passes = medium::correctedTransmittance<N>(
        *traced.media[traced.media.number(p.mediumSet, 0)].medium, depths, p.from.position,
        direction, contribution * (1 / traced.typicalRadiance), random, c);
    batch.counters.shadowSegments += c.segments;
    bring(batch, p, light * (1 / brightest) * toRgb(contribution * passes), kindOfLight(p, 1),
          group);
}

}  // namespace

template <int N, bool Surfaces>
void addSampled(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i,
                const LightChoice::Chosen& chosen, const EventNumbers& u,
                const FlightShare& share) {
    PathState<N, Surfaces>& p = batch.paths[i];
    const light::LightSet& lights = traced.scene.lights;
    light::LightSample s =
        lights.sample(chosen.light, p.from.position, u.light[0], u.light[1], p.time);
    if (!(s.weight.maximum() > 0)) return;
    const double phase = phaseDensity(p, dot(p.from.forward, s.direction), s.weight);
    double weight = phase / chosen.probability;
    if (s.pdf > 0) weight *= powerHeuristic(s.pdf * chosen.probability, phase);
    weight *= share(lights, chosen.light);
    const medium::DepthGrid* const depths = traced.lightDepth(p.mediumSet, chosen.light);
    if (!Surfaces && depths) {
        const Rgb light = s.weight * tint(p) * (static_cast<float>(weight) * p.sunShare);
        bringSunlight(traced, batch, p, *depths, s.direction, light,
                      lights.group(chosen.light, s.emitter));
        return;
    }
    if (addShadowRay(traced, batch, i, p.from.position, s.direction, s.distance,
                     s.weight * static_cast<float>(weight), true)) {
        batch.shadows.back().emitter = s.emitter;
        if constexpr (Surfaces) batch.shadows.back().lightDepth = depths;
        noteOrigin(batch, lights.group(chosen.light, s.emitter), 1);
    }
}

template <int N>
void addSunlight(const TracedScene& traced, Batch<N, false>& batch, std::size_t i,
                 const EventNumbers& u) {
    PathState<N, false>& p = batch.paths[i];
    const auto chosen = batch.choice.choose(p.from, u.pick);
    if (!chosen || !traced.lightDepth(p.mediumSet, chosen->light)) return;
    addSampled(traced, batch, i, *chosen, u, FlightShare());
}

template <int N, bool Surfaces>
void addNextEvent(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i,
                  const EventNumbers& u, const FlightShare& share) {
    const auto chosen = batch.choice.choose(batch.paths[i].from, u.pick);
    if (chosen) addSampled(traced, batch, i, *chosen, u, share);
}

template <int N, bool Surfaces>
void addLightHits(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i,
                  const FlightShare* share) {
    const light::LightSet& lights = traced.scene.lights;
    for (int light : lights.meetable()) {
        const light::LightTraits& traits = lights.traits(light);
        if (!share && !traits.visible) continue;
        const PathState<N, Surfaces>& p = batch.paths[i];
        const light::LightHit hit = lights.meet(light, p.origin, p.direction, p.time);
        if (!std::isfinite(hit.distance)) continue;
        if (!share) p.result->film.glow = 1;
        double weight = 1;
        if (share)
            weight = hitWeight(p, [&] { return batch.choice.pdf(light, p.from, p.direction); }) *
                     (*share)(lights, light);
        bool lightSampled = false;
        if constexpr (Surfaces)
            lightSampled = p.surfaces.lightSampled == SurfaceState::LightSampled::AtLastEvent;
        if (addShadowRay(traced, batch, i, p.origin, p.direction, hit.distance,
                         hit.radiance * static_cast<float>(weight), lightSampled)) {
            noteOrigin(batch, lights.group(light), 0);
            if (!share) noteOnCameraRay(traced, batch, hit.distance, true);
        }
    }
}

template <int N, bool Surfaces>
bool addShadowRay(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i, Vec3d origin,
                  Vec3d direction, double tMax, Rgb light, bool mayPass) {
    PathState<N, Surfaces>& p = batch.paths[i];
    light *= tint(p);
    const float brightest = light.maximum();
    const Spectrum<N> contribution = p.throughput * brightest;
    if (!(contribution.maximum() > 0)) return false;
    // Made in place: a copy just after it was written field by field waits for the writes.
    ShadowRay<Surfaces>& ray = batch.shadows.emplace_back();
    ray.path = i, ray.colour = light * (1 / brightest), ray.mediumSet = p.mediumSet;
    if constexpr (Surfaces) {
        ray.start = p.surfaces.way.start();
        ray.transparent = mayPass && traced.options.approximations.transparentShadows;
        ray.inFront = p.surfaces.seen;
    }
    medium::TransmittanceQuery<N>& query = batch.shadowQueries.emplace_back();
    query.origin = origin, query.direction = direction, query.tMax = tMax, query.time = p.time;
    query.random = RandomStream(p.random.bits());
    query.roulette = shadowRoulette * traced.typicalRadiance;
    query.contribution = contribution;
    return true;
}

#define INSTANTIATE(N, SURFACES)                                                                   \
    template void addSampled(const TracedScene&, Batch<N, SURFACES>&, std::size_t,                 \
                             const LightChoice::Chosen&, const EventNumbers&, const FlightShare&); \
    template void addNextEvent(const TracedScene&, Batch<N, SURFACES>&, std::size_t,               \
                               const EventNumbers&, const FlightShare&);                           \
    template void addLightHits(const TracedScene&, Batch<N, SURFACES>&, std::size_t,               \
                               const FlightShare*);                                                \
    template bool addShadowRay(const TracedScene&, Batch<N, SURFACES>&, std::size_t, Vec3d, Vec3d, \
                               double, Rgb, bool);
INSTANTIATE(1, false)
INSTANTIATE(1, true)
INSTANTIATE(3, false)
INSTANTIATE(3, true)
#undef INSTANTIATE
template void addSunlight(const TracedScene&, Batch<1, false>&, std::size_t, const EventNumbers&);
template void addSunlight(const TracedScene&, Batch<3, false>&, std::size_t, const EventNumbers&);

}  // namespace woodcock::render
