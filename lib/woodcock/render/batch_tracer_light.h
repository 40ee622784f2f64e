// SPDX-License-Identifier: Apache-2.0
#pragma once

// How batch_tracer.h samples light.

#include "woodcock/render/batch_tracer.h"

namespace woodcock::render {

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::addNextEvent(std::size_t i, const EventNumbers& u,
                                            const FlightShare& share) {
    Path& p = paths_[i];
    const auto chosen = choice_.choose(p.from, u.pick);
    if (!chosen) return;
    const light::LightSample s =
        scene_.lights.sample(chosen->light, p.from.position, u.light[0], u.light[1]);
    if (!(s.weight.maximum() > 0)) return;
    const double phase = medium::henyeyGreenstein(dot(p.from.forward, s.direction), p.from.g);
    double weight = phase / chosen->probability;
    if (s.pdf > 0) weight *= powerHeuristic(s.pdf * chosen->probability, phase);
    if (const auto lightPosition = localLightPosition(chosen->light))
        weight *= share(*lightPosition);
    if (addShadowRay(i, p.from.position, s.direction, s.distance,
                     s.weight * static_cast<float>(weight), true))
        shadows_.back().emitter = s.emitter;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::addSphereHits(std::size_t i, const FlightShare* share) {
    for (int light : scene_.lights.local()) {
        const auto* sphere = std::get_if<light::SphereLight>(
            &scene_.lights.lights()[static_cast<std::size_t>(light)]);
        if (!sphere || (!share && !sphere->visible)) continue;
        const Path& p = paths_[i];
        const double t = sphere->hit(p.origin, p.direction);
        if (!std::isfinite(t)) continue;
        if (!share) p.result->film.glow = 1;
        double weight = 1;
        if (share)
            weight = hitWeight(p, [&] { return choice_.pdf(light, p.from, p.direction); }) *
                     (*share)(sphere->position);
        bool lightSampled = false;
        if constexpr (Surfaces)
            lightSampled = p.surfaces.lightSampled == SurfaceState::LightSampled::AtLastEvent;
        addShadowRay(i, p.origin, p.direction, t, sphere->radiance * static_cast<float>(weight),
                     lightSampled);
    }
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::addEquiangular(std::size_t i, double u, double pick) {
    const Path& p = paths_[i];
    if (options_.maxScatterings && p.scatterings >= *options_.maxScatterings) return;
    const Flight flight = flightOf(p);
    if (p.mediumSet > 0 && !flight.medium->scatters) return;
    const auto localLights = scene_.lights.local();
    if (localLights.empty()) return;
    const double scaled = pick * static_cast<double>(localLights.size());
    const int light =
        localLights[std::min(static_cast<std::size_t>(scaled), localLights.size() - 1)];
    const Vec3d lightPosition = *localLightPosition(light);
    const Equiangular e = flight.equiangular(lightPosition);
    const double t = e.sample(u), pdf = e.pdf(t);
    if (!(pdf > 0)) return;
    const light::ScatterPoint at{p.origin + p.direction * t, p.direction, 0};
    const double lightU = scaled - std::floor(scaled);
    const light::LightSample s =
        scene_.lights.sample(light, at.position, lightU, paths_[i].random.uniform());
    if (!(s.weight.maximum() > 0)) return;
    const Onward onward = onwardFrom(paths_[i]);
    const double cosine = dot(at.forward, s.direction);
    Rgb scattered;  // sum over parts of sigma_s x phase
    for (const medium::MediumPart& part : flight.medium->medium->parts)
        scattered += part.sigmaS(at.position) *
                     static_cast<float>(medium::henyeyGreenstein(cosine, part.g() * onward.phase));
    // Balance heuristic against the event, over the density of this point and light.
    const double weight =
        onward.amount * static_cast<double>(localLights.size()) / (pdf + flight.density(e, t));
    if (!addShadowRay(i, p.origin, p.direction, t,
                      scattered * s.weight * static_cast<float>(weight), true))
        return;
    ShadowRay<Surfaces>& ray = shadows_.back();
    ray.secondLeg = true, ray.secondMediumSet = onward.mediumSet;
    ray.origin = at.position, ray.direction = s.direction, ray.tMax = s.distance;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::addMediumEmission(std::size_t i, double u) {
    const Path& p = paths_[i];
    const Flight flight = flightOf(p);
    const auto point = emission_.sample(flight.medium->emission, flight.origin, flight.direction,
                                        flight.tMax, flight.medium->meanExtinction, u);
    if (!point || !addShadowRay(i, p.origin, p.direction, point->t, point->light, false)) return;
    shadows_.back().withinFlight = true;
    if (seen(p)) p.result->film.glow = 1;
    // Points deep within dense media contribute little: beyond a depth of 9, roulette ends their
    // rays.
    medium::TransmittanceQuery<N>& query = shadowQueries_.back();
    query.roulette = std::max(query.roulette, 1e-4f * query.contribution.maximum());
}

template <int N, bool Surfaces>
bool BatchTracer<N, Surfaces>::addShadowRay(std::size_t i, Vec3d origin, Vec3d direction,
                                            double tMax, Rgb light, bool mayPass) {
    Path& p = paths_[i];
    light *= tint(p);
    const float brightest = light.maximum();
    const Spectrum<N> contribution = p.throughput * brightest;
    if (!(contribution.maximum() > 0)) return false;
    shadows_.push_back({.path = i, .colour = light * (1 / brightest)});
    shadows_.back().mediumSet = p.mediumSet;
    if constexpr (Surfaces) {
        shadows_.back().start = p.surfaces.start;
        shadows_.back().transparent = mayPass && options_.approximations.transparentShadows;
        shadows_.back().inFront = p.surfaces.seen;
    }
    shadowQueries_.push_back({origin, direction, tMax, RandomStream(p.random.bits()),
                              shadowRoulette * typicalRadiance_, contribution});
    return true;
}

}  // namespace woodcock::render
