// SPDX-License-Identifier: Apache-2.0
#pragma once

// Events in media: the flight that escapes, and the one that scatters.

#include "woodcock/render/batch_tracer.h"

namespace woodcock::render {

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::escape(Path& p) {
    p.alive = false;
    for (std::size_t i = 0; i < scene_.lights.lights().size(); ++i) {
        const int light = static_cast<int>(i);
        const Rgb radiance = scene_.lights.distantRadiance(light, p.direction, seen(p));
        if (!(radiance.maximum() > 0)) continue;
        const Rgb arrived = toRgb(p.throughput) * radiance * tint(p) *
                            static_cast<float>(hitWeight(
                                p, [&] { return choice_.pdf(light, p.from, p.direction); }));
        p.radiance += arrived;
        if (seen(p)) p.result->film.background += arrived;
    }
}

template <int N, bool Surfaces>
void BatchTracer<N, Surfaces>::scatter(std::size_t i, double t, double g) {
    Path& p = paths_[i];
    ++counters_.scatterings;
    const bool endless = inEndlessMedium(p);
    if (!Surfaces && endless && !needs_.emission && scene_.lights.local().empty()) {
        ++p.scatterings;
        p.alive = false;  // there is no light inside, and none arrives from infinity
        return;
    }
    const Vec3d position = p.origin + p.direction * t;
    const EventNumbers u = numbers(p);
    // The share that equiangular sampling of this flight leaves to this event; see addEquiangular.
    const FlightShare share{!needs_.localLights, flightOf(p), t};
    if (replacesMedia_) g *= enterMediumSet(p);
    p.from = {position, p.direction, g};
    if constexpr (Surfaces) {
        SurfaceState& s = p.surfaces;
        s.start.left.reset();
        s.seen = false;
        s.lightSampled = SurfaceState::LightSampled::AtLastEvent;
    }
    if (needs_.lightSampling) addNextEvent(i, u, share);

    const medium::PhaseSample s =
        medium::sampleHenyeyGreenstein(p.direction, g, u.phase[0], u.phase[1]);
    p.origin = position, p.direction = s.direction, p.phasePdf = s.pdf;
    p.flight = u.flight;
    ++p.scatterings;
    addSphereHits(i, &share);
    if (p.scatterings >= (endless ? firstEndlessRoulette : firstOrderRoulette) &&
        std::has_single_bit(static_cast<std::uint64_t>(p.scatterings))) {
        if (p.random.uniform() >= (endless ? double{endlessSurvival} : 0.70710678118654752)) {
            p.alive = false;
            return;
        }
        p.throughput *= endless ? 1 / endlessSurvival : 1.41421356f;
    }
    p.equiangular = u.equiangular, p.localLightPick = u.pick;
    if (octavesEnd_) p.alive = false;
}

template <int N, bool Surfaces>
EventNumbers BatchTracer<N, Surfaces>::numbers(Path& p) {
    std::int64_t order = p.scatterings;
    if constexpr (Surfaces) order += p.surfaces.bounces;
    if (order >= quasiRandomOrders) {
        auto& r = p.random;
        return {{r.uniform(), r.uniform()},
                {r.uniform(), r.uniform()},
                r.uniformOpenLow(),
                r.uniform(),
                r.uniform()};
    }
    const auto set = static_cast<std::uint32_t>(2 * order + 1);
    const auto a = p.sequence.draw(set), b = p.sequence.draw(set + 1);
    return {{a[0], a[1]}, {a[2], a[3]}, 1 - b[0], b[1], b[2]};
}

}  // namespace woodcock::render
