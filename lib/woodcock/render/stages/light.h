// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/stages/event_numbers.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Next-event estimation at the scattering event p.from of path i.
template <int N, bool Surfaces>
void addNextEvent(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i,
                  const EventNumbers& u, const FlightShare& share);

/// The same for a light that was chosen.
template <int N, bool Surfaces>
void addSampled(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i,
                const LightChoice::Chosen& chosen, const EventNumbers& u, const FlightShare& share);

/// The same for those lights alone of which grids know the optical depth, where there are no
/// surfaces.
template <int N>
void addSunlight(const TracedScene& traced, Batch<N, false>& batch, std::size_t i,
                 const EventNumbers& u);

/// Adds lights that the new direction meets, with the weight of multiple importance sampling that
/// next-event estimation leaves. Where `share` is null, the camera sees them.
template <int N, bool Surfaces>
void addLightHits(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i,
                  const FlightShare* share);

/// Adds a shadow ray that brings `light` times the path's throughput; false: that is zero, and none
/// was added. `mayPass`: transparent shadows apply to it.
template <int N, bool Surfaces>
bool addShadowRay(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i, Vec3d origin,
                  Vec3d direction, double tMax, Rgb light, bool mayPass);

/// Notes for the shadow ray that was added last which part of the picture its light belongs to: a
/// light group, and how often it is still to be scattered before it comes to the path's end.
template <int N, bool Surfaces>
void noteOrigin(Batch<N, Surfaces>& batch, image::LightGroup group, int eventsMore) {
    if (!batch.layers.splitsLight()) return;
    ShadowRay<Surfaces>& ray = batch.shadows.back();
    ray.kind = kindOfLight(batch.paths[ray.path], eventsMore);
    ray.group = group;
}

/// Adds light that has come to the path's end, and from there to the camera. `inFront`: on the
/// camera's first flight.
template <int N, bool Surfaces>
void bring(Batch<N, Surfaces>& batch, PathState<N, Surfaces>& p, Rgb light, image::LightKind kind,
           image::LightGroup group, bool inFront = false) {
    (inFront ? p.result->film.radiance : p.radiance) += light;
    // A shadow catcher's own light is not in the picture.
    if (batch.layers.splitsLight() && (inFront || !(p.result->catcher.weight > 0)))
        batch.layers.add(*p.result, kind, group, light);
}

/// The weight, by multiple importance sampling, of light that a path hits. pdf(): the density with
/// which next-event estimation at the last event would have sampled it.
template <int N, bool Surfaces, class F>
double hitWeight(const PathState<N, Surfaces>& p, F&& pdf) {
    if constexpr (Surfaces) {
        using enum SurfaceState::LightSampled;
        if (p.surfaces.lightSampled == Never) return 1;
        if (p.surfaces.lightSampled == ThroughDielectrics) return pdf() > 0 ? 0 : 1;
    } else {
        if (p.scatterings == 0) return 1;
    }
    return powerHeuristic(p.phasePdf, pdf());
}

}  // namespace woodcock::render
