// SPDX-License-Identifier: Apache-2.0
#pragma once

// How batch_tracer.h scatters on surfaces, and how it finds the layers of depth, albedo and normal.

#include "woodcock/render/batch_tracer.h"

namespace woodcock::render {

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::meetSurface(std::size_t i) {
    Path& p = paths_[i];
    SurfaceState& s = p.surfaces;
    const surface::SurfaceHit hit = s.ahead;
    const surface::SurfaceObject& object = nestedMedia_->object(hit);
    const Crossing crossing = nestedMedia_->cross(s.start.inside, p.direction, hit);
    p.origin = hit.position;
    s.start.left = hit;
    if (s.seen && object.holdout) {
        p.result->film.alpha = opacityOf(p);
        p.alive = false;
        return;
    }
    if (crossing.passes) {
        s.start.inside = crossing.beyond;
        goOn(p);
        return;
    }
    if (s.seen) {
        p.result->film.alpha = 1;
        if (object.matte) {
            p.alive = false;
            return;
        }
        if (object.shadowCatcher) {
            p.result->film.alpha = opacityOf(p);
            p.result->catcher.weight = p.throughput.mean();
        }
    }
    addEmission(p, hit, crossing.bsdf);
    if (options_.maxBounces && s.bounces >= *options_.maxBounces) {
        p.alive = false;
        return;
    }
    bounce(i, hit, crossing);
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::bounce(std::size_t i, const surface::SurfaceHit& hit,
                                      const Crossing& crossing) {
    Path& p = paths_[i];
    SurfaceState& s = p.surfaces;
    const Vec3d out = -p.direction;
    const EventNumbers u = numbers(p);
    const bool caught = s.seen && p.result->catcher.weight > 0;
    s.seen = false;
    s.start.inside = crossing.near;
    p.mediumSet = mediumSetAfter(p.scatterings);
    if (crossing.bsdf.smooth()) {
        p.from = {hit.position, p.direction, 0};
        if (needs_.lightSampling) lightSurface(i, u, hit, crossing, out, caught);
    }

    const surface::BsdfSample b =
        crossing.bsdf.sample(out, {u.phase[0], u.phase[1], p.random.uniform()});
    multiply(p, b.weight);
    if (!(brightness(p) > 0)) {
        p.alive = false;
        return;
    }
    p.direction = b.direction, p.phasePdf = b.pdf, p.flight = u.flight;
    p.equiangular = u.equiangular, p.localLightPick = u.pick;
    s.lightSampled = lightSampledAfter(s.lightSampled, crossing.bsdf, b);
    if (b.transmitted) s.start.inside = crossing.beyond;
    ++s.bounces;
    if (caught) addUnoccluded(p);
    const FlightShare wholly;
    addSphereHits(i, &wholly);
    playRoulette(p);
}

template <int N, bool Surfaces>
SurfaceState::LightSampled BatchTracer<N, Surfaces>::lightSampledAfter(
    SurfaceState::LightSampled before, const surface::Bsdf& bsdf,
    const surface::BsdfSample& b) const {
    using enum SurfaceState::LightSampled;
    if (!b.delta) return AtLastEvent;
    // Next-event estimation lights the smooth part only: it cannot find a delta part's direction.
    const bool straight =
        options_.approximations.transparentShadows && b.transmitted && !bsdf.smooth();
    return straight && before != Never ? ThroughDielectrics : Never;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::goOn(Path& p) {
    p.flight = p.random.uniformOpenLow();
    p.equiangular = p.random.uniform(), p.localLightPick = p.random.uniform();
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::addEmission(Path& p, const surface::SurfaceHit& hit,
                                           const surface::Bsdf& bsdf) {
    const Rgb radiance = bsdf.emitted(-p.direction);
    if (!(radiance.maximum() > 0)) return;
    const auto pdf = [&] {
        const std::uint32_t emitter = nestedMedia_->emitter(hit);
        const light::MeshLight* light = scene_.lights.mesh();
        if (emitter == surface::SurfaceObject::dark || !light) return 0.0;
        return light->pdf(p.from.position, emitter, hit.position) *
               choice_.probability(scene_.lights.meshIndex(), p.from);
    };
    p.radiance += toRgb(p.throughput) * tint(p) * radiance * static_cast<float>(hitWeight(p, pdf));
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::lightSurface(std::size_t i, const EventNumbers& u,
                                            const surface::SurfaceHit& hit,
                                            const Crossing& crossing, Vec3d out, bool caught) {
    Path& p = paths_[i];
    const auto chosen = choice_.choose(p.from, u.pick);
    if (!chosen) return;
    const light::LightSample l =
        scene_.lights.sample(chosen->light, hit.position, u.light[0], u.light[1]);
    if (!(l.weight.maximum() > 0) || nestedMedia_->startsOn(hit, l.emitter)) return;
    const Rgb f = crossing.bsdf.evaluate(out, l.direction);
    if (!(f.maximum() > 0)) return;
    double weight = 1 / chosen->probability;
    if (l.pdf > 0)
        weight *= powerHeuristic(l.pdf * chosen->probability, crossing.bsdf.pdf(out, l.direction));
    if (caught)
        p.result->catcher.unlit += (toRgb(p.throughput) * tint(p) * f * l.weight).mean() *
                                   static_cast<float>(1 / chosen->probability);
    if (!addShadowRay(i, hit.position, l.direction, l.distance,
                      f * l.weight * static_cast<float>(weight), true))
        return;
    shadows_.back().emitter = l.emitter;
    if (dot(out, hit.normal) * dot(l.direction, hit.normal) < 0)
        shadows_.back().start.inside = crossing.beyond;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::addUnoccluded(Path& p) {
    for (const light::Light& light : scene_.lights.lights()) {
        const auto* environment = std::get_if<light::Environment>(&light);
        if (environment && environment->constant())
            p.result->catcher.unlit +=
                (toRgb(p.throughput) * tint(p) * environment->radiance(p.direction)).mean();
    }
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::playRoulette(Path& p) {
    const float weight = brightness(p);
    float survival = std::min(1.0f, weight / pathRoulette);
    if (p.surfaces.bounces >= firstBounceRoulette) survival *= bounceSurvival;
    if (survival >= 1) return;
    if (p.random.uniform() >= survival)
        p.alive = false;
    else
        p.throughput *= 1 / survival;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::findShadowAcrossSurfaces(ShadowRay<Surfaces>& shadow,
                                                        medium::TransmittanceQuery<N>& q,
                                                        medium::TrackingCounters& c) {
    if (!(q.contribution.maximum() > 0)) return;
    pieces_.clear();
    NestedMedia::RayStart place = shadow.start;
    Vec3d origin = q.origin;
    double left = q.tMax;
    surface::SurfaceHit hit;
    Rgb passed(1.0f);
    const bool toSurface = shadow.emitter != light::LightSample::none;
    while (true) {
        counters_.surfaceRays += !shadow.withinFlight;
        bool hits = !shadow.withinFlight &&
                    nestedMedia_->nearest(origin, q.direction,
                                          left * (toSurface ? behindLight : beforeLight), place,
                                          false, hit);
        if (hits && toSurface) hits = !arrives(shadow, hit, left);
        pieces_.push_back(
            {origin, hits ? hit.t : left, mediumIndex(shadow.mediumSet, place.inside)});
        if (!hits) break;
        const Crossing crossing = nestedMedia_->cross(place.inside, q.direction, hit);
        if (!crossing.passes) {
            if (!shadow.transparent || crossing.bsdf.smooth() || !crossing.bsdf.transmits()) {
                q.contribution = {};
                return;
            }
            passed = passed * crossing.bsdf.straightTransmittance(q.direction);
        }
        place.inside = crossing.beyond;
        place.left = hit;
        origin = hit.position;
        left -= hit.t;
    }
    q.contribution *= passed.mean();
    for (const Piece& piece : pieces_) {
        const medium::Medium& medium = *media_[piece.medium].medium;
        if (medium.parts.empty()) continue;
        q.origin = piece.origin, q.tMax = piece.length;
        findTransmittances(medium, {&q, 1}, c);
        if (!(q.contribution.maximum() > 0)) return;
    }
}

/// Where an emitter coincides with other surfaces, a shadow ray reaches it only if it is the one
/// that counts.
template <int N, bool Surfaces>
bool BatchTracer<N, Surfaces>::arrives(const ShadowRay<Surfaces>& shadow,
                                       const surface::SurfaceHit& hit, double left) const {
    if (hit.coincident.any) return nestedMedia_->emitter(hit) == shadow.emitter;
    return hit.t > left * beforeLight;
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::findDepth(const Path& p) {
    medium::DistanceQuery<N> q{p.origin,
                               p.direction,
                               infinity,
                               p.flight,
                               RandomStream(RandomStream(p.random).bits()),
                               0,
                               true,
                               Spectrum<N>(1.0f),
                               0,
                               -1};
    medium::TrackingCounters c;
    image::DepthSample& depth = p.result->depth;
    const medium::Medium* medium = &scene_.medium;
    double behind = 0;  // distance to where the query starts
    if constexpr (Surfaces) {
        NestedMedia::RayStart place = p.surfaces.start;
        while (true) {
            surface::SurfaceHit hit;
            const bool hits =
                nestedMedia_->nearest(q.origin, q.direction, infinity, place, true, hit);
            q.tMax = hits ? hit.t : infinity;
            medium = media_[mediumIndex(p.mediumSet, place.inside)].medium;
            findEvents(*medium, {&q, 1}, c);
            if (q.part >= 0 || !hits) break;
            const Crossing crossing = nestedMedia_->cross(place.inside, q.direction, hit);
            if (nestedMedia_->object(hit).holdout) return;
            if (!crossing.passes) {
                const float weight = q.throughput.mean();
                const Vec3d n =
                    hit.shadingNormal * (dot(hit.normal, q.direction) < 0 ? weight : -weight);
                depth = {{},
                         weight * static_cast<float>(behind + hit.t),
                         weight,
                         toRgb(q.throughput) * crossing.bsdf.albedo(),
                         n.as<float>()};
                return;
            }
            place.inside = crossing.beyond, place.left = hit;
            behind += hit.t;
            q.origin = hit.position, q.u = q.random.uniformOpenLow();
        }
    } else {
        medium = media_[p.mediumSet].medium;
        findEvents(*medium, {&q, 1}, c);
    }
    if (q.part < 0) {
        depth.transmittance = toRgb(q.throughput);
        return;
    }
    const float weight = q.throughput.mean();
    depth.weightedDepth = weight * static_cast<float>(behind + q.t);
    depth.weight = weight;
    if (!options_.featureLayers) return;
    const Vec3d met = q.origin + q.direction * q.t;
    depth.weightedAlbedo = toRgb(q.throughput) * medium::scatteringAlbedo(*medium, met);
    depth.weightedNormal = (medium::densityNormal(*medium, met) * weight).template as<float>();
}

}  // namespace woodcock::render
