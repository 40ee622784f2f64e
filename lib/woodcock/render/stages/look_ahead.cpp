// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/look_ahead.h"

#include <algorithm>
#include <cmath>

#include "woodcock/medium/phase.h"
#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/light.h"

namespace woodcock::render {

namespace {

template <int N, bool Surfaces>
void findMediumAndSurface(const TracedScene& traced, Batch<N, Surfaces>& batch,
                          PathState<N, Surfaces>& p) {
    if constexpr (Surfaces) {
        BoundaryWalk& way = p.surfaces.way;
        p.medium = traced.mediumAround(p.mediumSet, way.inside());
        way.next(*traced.surfaces, {.origin = p.origin,
                                    .direction = p.direction,
                                    .time = p.time,
                                    .cameraRay = p.surfaces.seen});
        ++batch.counters.surfaceRays;
    } else {
        p.medium = traced.media.number(p.mediumSet, 0);
    }
}

/// Adds the light that media emit along the flight ahead, by one random point of it.
template <int N, bool Surfaces>
void addMediumEmission(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i,
                       double u) {
    const PathState<N, Surfaces>& p = batch.paths[i];
    const Flight flight = traced.flightOf(p);
    const auto point =
        batch.emission.sample(flight.medium->emission, {.origin = flight.origin,
                                                        .direction = flight.direction,
                                                        .time = flight.time,
                                                        .tMax = flight.tMax,
                                                        .extinction = flight.medium->meanExtinction,
                                                        .u = u});
    if (!point ||
        !addShadowRay(traced, batch, i, p.origin, p.direction, point->t, point->light, false))
        return;
    batch.shadows.back().withinFlight = true;
    noteOrigin(batch, point->group, 0);
    noteOnCameraRay(traced, batch, point->t);
    if (seen(p)) p.result->film.glow = 1;
    // Points deep within dense media contribute little: beyond a depth of 9, roulette ends their
    // rays.
    medium::TransmittanceQuery<N>& query = batch.shadowQueries.back();
    query.roulette = std::max(query.roulette, 1e-4f * query.contribution.maximum());
}

/// Adds what a local light sends through a point of the flight ahead that is drawn for it; see
/// FlightShare.
template <int N, bool Surfaces>
void addEquiangular(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i, double u,
                    double pick) {
    PathState<N, Surfaces>& p = batch.paths[i];
    const light::LightSet& lights = traced.scene.lights;
    if (!traced.mayScatter(p.scatterings)) return;
    const Flight flight = traced.flightOf(p);
    if (p.mediumSet > 0 && !flight.medium->scatters) return;
    const auto localLights = lights.local();
    if (localLights.empty()) return;
    const double scaled = pick * static_cast<double>(localLights.size());
    const int light =
        localLights[std::min(static_cast<std::size_t>(scaled), localLights.size() - 1)];
    const Equiangular e = flight.equiangular(lights, light, *lights.position(light, p.time));
    const double t = e.sample(u), pdf = e.pdf(t);
    if (!(pdf > 0)) return;
    const light::ScatterPoint at{p.origin + p.direction * t, p.direction};
    const double lightU = scaled - std::floor(scaled);
    const light::LightSample s =
        lights.sample(light, at.position, lightU, p.random.uniform(), p.time);
    if (!(s.weight.maximum() > 0)) return;
    const MediaTable::Onward onward = traced.media.onward(p.scatterings, p.random);
    const double cosine = dot(at.forward, s.direction);
    Rgb scattered;  // sum over parts of sigma_s x phase
    const auto& parts = flight.medium->medium->parts;
    const auto& scatterers = traced.media.phasesOfSetOnward()
                                 ? traced.mediumAround(p, onward.mediumSet).medium->parts
                                 : parts;
    for (std::size_t k = 0; k < parts.size(); ++k)
        scattered += parts[k].sigmaS(at.position, p.time) * scatterers[k].phase().values(cosine);
    // Balance heuristic against the event, over the density of this point and light.
    const double weight =
        onward.amount * static_cast<double>(localLights.size()) / (pdf + flight.density(e, t));
    if (!addShadowRay(traced, batch, i, p.origin, p.direction, t,
                      scattered * s.weight * static_cast<float>(weight), true))
        return;
    ShadowRay<Surfaces>& ray = batch.shadows.back();
    ray.withinFlight = true;
    noteOrigin(batch, lights.group(light, s.emitter), 1);
    ray.secondLeg = true, ray.secondMediumSet = onward.mediumSet;
    ray.origin = at.position, ray.direction = s.direction, ray.tMax = s.distance;
    noteOnCameraRay(traced, batch, t);
}

}  // namespace

template <int N, bool Surfaces>
void lookAhead(const TracedScene& traced, Batch<N, Surfaces>& batch) {
    for (std::size_t i = 0; i < batch.paths.size(); ++i) {
        PathState<N, Surfaces>& p = batch.paths[i];
        findMediumAndSurface(traced, batch, p);
        if (traced.needs.emission) addMediumEmission(traced, batch, i, p.equiangular);
        if (traced.needs.localLights)
            addEquiangular(traced, batch, i, p.equiangular, p.localLightPick);
    }
}

template void lookAhead(const TracedScene&, Batch<1, false>&);
template void lookAhead(const TracedScene&, Batch<1, true>&);
template void lookAhead(const TracedScene&, Batch<3, false>&);
template void lookAhead(const TracedScene&, Batch<3, true>&);

}  // namespace woodcock::render
