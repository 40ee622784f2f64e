// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/stages/shade_media.h"

#include "woodcock/medium/phase.h"
#include "woodcock/render/stages/light.h"
#include "woodcock/render/stages/roulette.h"
#include "woodcock/render/stages/several_events.h"
#include "woodcock/render/stages/turn.h"

namespace woodcock::render {

namespace {

/// True outside of all surfaces, in a medium that fills all of space.
template <int N, bool Surfaces>
bool inEndlessMedium(const TracedScene& traced, const PathState<N, Surfaces>& p) {
    if (!traced.media[p.medium].unbounded) return false;
    if constexpr (Surfaces) return traced.surfaces->medium(p.surfaces.way.inside()) == 0;
    return true;
}

/// Makes the path go on through the media that approximations choose.
template <int N, bool Surfaces>
void enterMediumSet(const TracedScene& traced, PathState<N, Surfaces>& p) {
    const MediaTable::Onward onward = traced.media.onward(p.scatterings, p.random);
    p.mediumSet = onward.mediumSet;
    p.throughput *= static_cast<float>(onward.amount);
}

}  // namespace

template <int N, bool Surfaces>
void escape(const TracedScene& traced, Batch<N, Surfaces>& batch, PathState<N, Surfaces>& p) {
    p.alive = false;
    for (int light : traced.scene.lights.distant()) {
        const Rgb radiance = traced.scene.lights.distantRadiance(light, p.direction, seen(p));
        if (!(radiance.maximum() > 0)) continue;
        const Rgb arrived = toRgb(p.throughput) * radiance * tint(p) *
                            static_cast<float>(hitWeight(
                                p, [&] { return batch.choice.pdf(light, p.from, p.direction); }));
        image::LightKind kind = kindOfLight(p, 0);
        if (kind == image::LightKind::Emission) kind = image::LightKind::Background;
        bring(batch, p, arrived, kind, traced.scene.lights.group(light));
        if (seen(p)) p.result->film.background += arrived;
    }
}

template <int N, bool Surfaces>
void scatter(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i, double t,
             std::size_t part) {
    PathState<N, Surfaces>& p = batch.paths[i];
    const Needs& needs = traced.needs;
    ++batch.counters.scatterings;
    const bool endless = inEndlessMedium(traced, p);
    if (!Surfaces && endless && !needs.emission && traced.scene.lights.local().empty()) {
        ++p.scatterings;
        p.alive = false;  // there is no light inside, and none arrives from infinity
        return;
    }
    const Vec3d position = p.origin + p.direction * t;
    const EventNumbers u = drawNumbers(p);
    // The share that equiangular sampling of this flight leaves to this event; see addEquiangular.
    const FlightShare share{.all = !needs.localLights, .flight = traced.flightOf(p), .t = t};
    const auto phaseOf = [&](const MediumSummary& m) { return &m.medium->parts[part].phase(); };
    const medium::PhaseFunction* phase = phaseOf(traced.media[p.medium]);
    if (traced.media.replaces()) {
        enterMediumSet(traced, p);
        if (traced.media.phasesOfSetOnward()) phase = phaseOf(traced.mediumAround(p, p.mediumSet));
    }
    p.from = {position, p.direction, phase, p.time};
    if constexpr (Surfaces) {
        SurfaceState& s = p.surfaces;
        s.way.leaveSurface();
        s.seen = false;
        s.lightSampled = SurfaceState::LightSampled::AtLastEvent;
    }
    if (needs.lightSampling) addNextEvent(traced, batch, i, u, share);

    if constexpr (!Surfaces)
        if (traced.severalEvents) drawSeveralEvents(traced, batch, i);

    const medium::PhaseSample s = turn(p, *phase, u.phase);
    p.origin = position, p.direction = s.direction, p.phasePdf = s.pdf;
    p.flight = u.flight;
    ++p.scatterings;
    addLightHits(traced, batch, i, &share);
    if (!surviveOrder(p, endless)) return;
    p.equiangular = u.equiangular, p.localLightPick = u.pick;
    if (traced.media.octavesEnd()) p.alive = false;
}

#define INSTANTIATE(N, SURFACES)                                                            \
    template void escape(const TracedScene&, Batch<N, SURFACES>&, PathState<N, SURFACES>&); \
    template void scatter(const TracedScene&, Batch<N, SURFACES>&, std::size_t, double,     \
                          std::size_t);
INSTANTIATE(1, false)
INSTANTIATE(1, true)
INSTANTIATE(3, false)
INSTANTIATE(3, true)
#undef INSTANTIATE

}  // namespace woodcock::render
