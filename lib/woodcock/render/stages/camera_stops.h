// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

// What stops the light of camera rays, and from where they bring it: PathResult::stopped, for
// mattes and deep pixels. All of it comes from the path itself, so it agrees with the film's sample
// of that path: the stops add up to its alpha, the arrivals to its radiance.

/// Planar depth along a path's flight, from the camera as it is at the path's time; not negative.
class PlanarDepth {
public:
    template <int N, bool Surfaces>
    PlanarDepth(const TracedScene& traced, const PathState<N, Surfaces>& p) {
        const Affine3d worldFromCamera = traced.scene.camera.at(p.time).worldFromCamera;
        const Vec3d forward = normalize(worldFromCamera.vector({0, 0, -1}));
        here_ = dot(p.origin - worldFromCamera.translation, forward);
        slope_ = dot(p.direction, forward);
    }
    double at(double t) const { return std::max(0.0, here_ + t * slope_); }

private:
    double here_, slope_;
};

/// Whether what path p meets now is met by its camera ray, and somebody asks for it.
template <int N, bool Surfaces>
bool isToBeNoted(const TracedScene& traced, const PathState<N, Surfaces>& p) {
    return traced.options.stoppedLight && seen(p);
}

/// Where the flight of path i is to note its collisions; null: nowhere.
template <int N, bool Surfaces>
std::vector<medium::FlightCollision>* collisionsToNote(const TracedScene& traced,
                                                       Batch<N, Surfaces>& batch, std::size_t i) {
    if (!isToBeNoted(traced, batch.paths[i])) return nullptr;
    batch.collisions.resize(std::max(batch.collisions.size(), batch.paths.size()));
    batch.depths.resize(batch.collisions.size());
    batch.collisions[i].clear(), batch.depths[i].clear();
    return &batch.collisions[i];
}

/// Makes stops of what the flight of path i has noted.
template <int N, bool Surfaces>
void noteStops(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i);

/// The last shadow ray that was added brings light from distance t of its path's flight: notes
/// that, if that is a camera ray. `fromLamp`: not from media.
template <int N, bool Surfaces>
void noteOnCameraRay(const TracedScene& traced, Batch<N, Surfaces>& batch, double t,
                     bool fromLamp = false) {
    ShadowRay<Surfaces>& ray = batch.shadows.back();
    const PathState<N, Surfaces>& p = batch.paths[ray.path];
    if (!isToBeNoted(traced, p)) return;
    ray.fromLamp = fromLamp;
    ray.cameraDepth = static_cast<float>(PlanarDepth(traced, p).at(t));
}

/// The same of one part of the outer medium, which stops so much at a depth.
void addStop(const TracedScene& traced, image::StoppedLight& stopped, double depth,
             std::size_t part, double amount);

/// The camera ray of path p ends at distance t, as the path scatters there.
template <int N, bool Surfaces>
void noteFirstScattering(const TracedScene& traced, const PathState<N, Surfaces>& p, double t) {
    p.result->stopped->firstEvent = {PlanarDepth(traced, p).at(t), {}, false};
}

/// It ends at the surface that it has met.
template <int N>
void noteFirstSurface(const TracedScene& traced, const PathState<N, true>& p);

/// To be called last: makes the stops add up to the sample's alpha exactly, and adds what arrives
/// from the path's first event.
void completeStops(PathResult& result);

}  // namespace woodcock::render
