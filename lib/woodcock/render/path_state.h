// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "woodcock/base/random.h"
#include "woodcock/base/sample_sequence.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/light/light_set.h"
#include "woodcock/render/boundary_walk.h"
#include "woodcock/render/path_tracer.h"

namespace woodcock::render {

/// A path's state where the scene has surfaces.
struct SurfaceState {
    BoundaryWalk way;  ///< where the flight starts, and the surface at its end
    Rgb tint{1.0f};    ///< colour of surfaces, where the throughput has one channel
    int bounces = 0;
    bool seen = true;           ///< by the camera: the ray has met only boundaries so far
    bool surfaceFirst = false;  ///< the first thing that it met otherwise was a surface
    /// Whether next-event estimation has sampled the light that the path hits.
    enum class LightSampled {
        Never,              ///< it could not choose this direction: the light counts in full
        AtLastEvent,        ///< it could: the light is weighted by multiple importance sampling
        ThroughDielectrics  ///< it did, by transparent shadows: the light does not count
    } lightSampled = LightSampled::Never;
};
struct Nothing {};

/// A path between two events, as a plain value.
/// N: tracked channels. Surfaces: whether the scene has any.
template <int N, bool Surfaces>
struct PathState {
    PathResult* result;
    SampleSequence sequence;
    RandomStream random;
    Vec3d origin, direction;         ///< of the flight ahead
    std::array<double, 2> raster{};  ///< of the camera ray, in pixels
    float time = 0;  ///< of the whole path, within the shutter: see camera::CameraRay
    Spectrum<N> throughput{1.0f};
    /// Of absorbing media on the camera's ray: 1 - throughput without rounding.
    Spectrum<N> opacity{};
    Rgb radiance{};
    std::int64_t scatterings = 0;
    light::ScatterPoint from{};  ///< the last event, for MIS at what its direction hits
    double phasePdf = 0;         ///< of that direction
    /// Of the light of suns and lamps with depth grids, what the next event is to bring: see
    /// several_events.h.
    float sunShare = 1;
    double flight = 1;  ///< draws the next optical depth
    /// Draw the flight's equiangular point, and the light for it.
    double equiangular = 0, localLightPick = 0;
    bool alive = true;
    std::uint8_t mediumSet = 0;  ///< of the media that the flight goes through: see MediaTable
    std::uint32_t medium = 0;    ///< that the flight goes through; set by lookAhead()
    [[no_unique_address]] std::conditional_t<Surfaces, SurfaceState, Nothing> surfaces = {};
};

/// True while the camera's ray has not scattered.
template <int N, bool Surfaces>
bool seen(const PathState<N, Surfaces>& p) {
    if constexpr (Surfaces)
        return p.surfaces.seen;
    else
        return p.scatterings == 0;
}

template <int N, bool Surfaces>
Rgb tint(const PathState<N, Surfaces>& p) {
    if constexpr (Surfaces)
        return p.surfaces.tint;
    else
        return Rgb(1.0f);
}

/// The kind of light that comes to the path's end, after so many events more.
template <int N, bool Surfaces>
image::LightKind kindOfLight(const PathState<N, Surfaces>& p, int eventsMore) {
    std::int64_t events = p.scatterings + eventsMore;
    bool surfaceFirst = false;
    if constexpr (Surfaces) events += p.surfaces.bounces, surfaceFirst = p.surfaces.surfaceFirst;
    using enum image::LightKind;
    if (events == 0) return Emission;
    if (surfaceFirst) return events == 1 ? SurfaceDirect : SurfaceIndirect;
    return events == 1 ? VolumeDirect : VolumeIndirect;
}

template <int N>
Rgb toRgb(Spectrum<N> s) {
    return Rgb::map([&](int c) { return s[N == 1 ? 0 : c]; });
}

/// Opacity of the media through which the camera's ray has come so far.
template <int N, bool Surfaces>
float opacityOf(const PathState<N, Surfaces>& p) {
    const float lost = 1 - p.throughput.mean(), opacity = p.opacity.mean();
    constexpr float rounding = 1e-6f;  // differences up to this are rounding
    return opacity > 0 && std::abs(lost - opacity) < rounding ? opacity : lost;
}

/// Light along one or two straight legs, and the path that it lights. The query beside it carries
/// the ray and the medium's channels. The light's colour, its largest channel 1, stays here.
template <bool Surfaces>
struct ShadowRay {
    std::size_t path;
    Rgb colour;
    bool secondLeg = false;
    bool transparent = false;          ///< passes dielectrics
    bool inFront = false;              ///< brings light of the camera's first flight
    bool withinFlight = false;         ///< no surface lies in its way, on the first leg
    std::uint8_t mediumSet = 0;        ///< which media it goes through
    std::uint8_t secondMediumSet = 0;  ///< and on its second leg
    // Where the picture's light is split into parts:
    image::LightKind kind = {};
    image::LightGroup group = 0;
    std::uint32_t emitter = light::LightSample::none;  ///< the triangle that it goes to
    /// Planar depth on the camera's ray from which its light comes, where that is asked for and no
    /// event of the path is there; else negative.
    float cameraDepth = -1;
    bool fromLamp = false;  ///< there
    /// Of the light that it goes to, where the scene has surfaces; null: it is tracked.
    const medium::DepthGrid* lightDepth = nullptr;
    Vec3d origin = {}, direction = {};  ///< of the second leg
    double tMax = 0;
    [[no_unique_address]] std::conditional_t<Surfaces, NestedMedia::RayStart, Nothing> start = {};
};

}  // namespace woodcock::render
