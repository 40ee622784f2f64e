// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/shade_surfaces.h"

#include "woodcock/render/stages/camera_stops.h"
#include "woodcock/render/stages/light.h"
#include "woodcock/render/stages/roulette.h"

namespace woodcock::render {

namespace {

template <int N>
using Path = PathState<N, true>;

/// Weights the path by a surface's colour: in its throughput where three channels are tracked, else
/// in its tint.
template <int N>
void multiply(Path<N>& p, Rgb weight) {
    if constexpr (N == 3)
        p.throughput *= weight;
    else
        p.surfaces.tint *= weight;
}

template <int N>
float brightness(const Path<N>& p) {
    return (toRgb(p.throughput) * p.surfaces.tint).maximum();
}

/// Goes on behind a boundary that changes only the medium.
template <int N>
void goOn(Path<N>& p, const Crossing& crossing) {
    p.surfaces.way.pass(crossing);
    p.flight = p.random.uniformOpenLow();
    p.equiangular = p.random.uniform(), p.localLightPick = p.random.uniform();
}

/// Adds the light that the surface sends to where the path came from.
template <int N>
void addEmission(const TracedScene& traced, Batch<N, true>& batch, Path<N>& p,
                 const surface::Bsdf& bsdf) {
    const Rgb radiance = bsdf.emitted(-p.direction);
    if (!(radiance.maximum() > 0)) return;
    const surface::SurfaceHit& hit = p.surfaces.way.hit();
    const auto pdf = [&] {
        const std::uint32_t emitter = traced.surfaces->emitter(hit);
        const light::MeshLight* light = traced.scene.lights.mesh();
        if (emitter == surface::SurfaceObject::dark || !light) return 0.0;
        return light->pdf(p.from.position, emitter, hit.position, p.time) *
               batch.choice.probability(traced.scene.lights.meshIndex(), p.from);
    };
    bring(batch, p,
          toRgb(p.throughput) * tint(p) * radiance * static_cast<float>(hitWeight(p, pdf)),
          kindOfLight(p, 0), traced.surfaces->object(hit).lightGroup);
}

/// Next-event estimation at a surface.
template <int N>
void lightSurface(const TracedScene& traced, Batch<N, true>& batch, std::size_t i,
                  const EventNumbers& u, const Crossing& crossing, Vec3d out, bool caught) {
    Path<N>& p = batch.paths[i];
    const surface::SurfaceHit& hit = p.surfaces.way.hit();
    const auto chosen = batch.choice.choose(p.from, u.pick);
    if (!chosen) return;
    const light::LightSample l =
        traced.scene.lights.sample(chosen->light, hit.position, u.light[0], u.light[1], p.time);
    if (!(l.weight.maximum() > 0) || traced.surfaces->startsOn(hit, l.emitter)) return;
    const Rgb f = crossing.bsdf.evaluate(out, l.direction);
    if (!(f.maximum() > 0)) return;
    double weight = 1 / chosen->probability;
    if (l.pdf > 0)
        weight *= powerHeuristic(l.pdf * chosen->probability, crossing.bsdf.pdf(out, l.direction));
    if (caught)
        p.result->catcher.unlit += (toRgb(p.throughput) * tint(p) * f * l.weight).mean() *
                                   static_cast<float>(1 / chosen->probability);
    if (!addShadowRay(traced, batch, i, hit.position, l.direction, l.distance,
                      f * l.weight * static_cast<float>(weight), true))
        return;
    noteOrigin(batch, traced.scene.lights.group(chosen->light, l.emitter), 1);
    ShadowRay<true>& ray = batch.shadows.back();
    ray.emitter = l.emitter, ray.lightDepth = traced.lightDepth(p.mediumSet, chosen->light);
    if (dot(out, hit.normal) * dot(l.direction, hit.normal) < 0) ray.start.inside = crossing.beyond;
}

/// For shadow catchers: adds the unoccluded light, from the direction that was drawn, of lights
/// that next-event estimation leaves out.
template <int N>
void addUnoccluded(const TracedScene& traced, Path<N>& p) {
    const light::LightSet& lights = traced.scene.lights;
    for (int light : lights.distant())
        if (!lights.traits(light).sampled)
            p.result->catcher.unlit +=
                (toRgb(p.throughput) * tint(p) * lights[light].distantRadiance(p.direction)).mean();
}

SurfaceState::LightSampled lightSampledAfter(SurfaceState::LightSampled before,
                                             const surface::Bsdf& bsdf,
                                             const surface::BsdfSample& b,
                                             bool transparentShadows) {
    using enum SurfaceState::LightSampled;
    if (!b.delta) return AtLastEvent;
    // Next-event estimation lights the smooth part only: it cannot find a delta part's direction.
    const bool straight = transparentShadows && b.transmitted && !bsdf.smooth();
    return straight && before != Never ? ThroughDielectrics : Never;
}

/// Gives the path its next direction.
template <int N>
void bounce(const TracedScene& traced, Batch<N, true>& batch, std::size_t i,
            const Crossing& crossing) {
    Path<N>& p = batch.paths[i];
    SurfaceState& s = p.surfaces;
    const Vec3d out = -p.direction;
    const EventNumbers u = drawNumbers(p);
    const bool caught = s.seen && p.result->catcher.weight > 0;
    s.surfaceFirst |= s.seen;
    s.seen = false;
    s.way.goOnFromHit(crossing.near);
    p.mediumSet = traced.media.setAfter(p.scatterings);
    if (crossing.bsdf.smooth()) {
        p.from = {.position = p.origin, .forward = p.direction, .time = p.time};
        if (traced.needs.lightSampling) lightSurface(traced, batch, i, u, crossing, out, caught);
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
    s.lightSampled = lightSampledAfter(s.lightSampled, crossing.bsdf, b,
                                       traced.options.approximations.transparentShadows);
    if (b.transmitted) s.way.goOnFromHit(crossing.beyond);
    ++s.bounces;
    if (caught) addUnoccluded(traced, p);
    const FlightShare wholly;
    addLightHits(traced, batch, i, &wholly);
    surviveBounce(p, brightness(p));
}

}  // namespace

template <int N>
void meetSurface(const TracedScene& traced, Batch<N, true>& batch, std::size_t i) {
    Path<N>& p = batch.paths[i];
    SurfaceState& s = p.surfaces;
    const surface::SurfaceHit& hit = s.way.hit();
    const surface::SurfaceObject& object = traced.surfaces->object(hit);
    p.origin = hit.position;
    if (s.seen && object.holdout) {
        p.result->film.alpha = opacityOf(p);
        p.alive = false;
        return;
    }
    const Crossing crossing = s.way.crossing(*traced.surfaces, p.direction);
    if (crossing.passes) {
        goOn(p, crossing);
        return;
    }
    if (s.seen) {
        if (isToBeNoted(traced, p)) noteFirstSurface(traced, p);
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
    addEmission(traced, batch, p, crossing.bsdf);
    if (traced.options.maxBounces && s.bounces >= *traced.options.maxBounces) {
        p.alive = false;
        return;
    }
    bounce(traced, batch, i, crossing);
}

template void meetSurface(const TracedScene&, Batch<1, true>&, std::size_t);
template void meetSurface(const TracedScene&, Batch<3, true>&, std::size_t);

}  // namespace woodcock::render
