// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "woodcock/base/sample_sequence.h"
#include "woodcock/light/light.h"
#include "woodcock/render/flight.h"
#include "woodcock/render/nested_media.h"
#include "woodcock/render/path_tracer.h"

namespace woodcock::render {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Throughput below which paths play Russian roulette (absorption is a weight).
inline constexpr float pathRoulette = 0.1f;
/// Shadow rays play it below this part of LightSet::typicalRadiance().
inline constexpr float shadowRoulette = 0.05f;
/// The first scattering orders take their numbers from the quasi-random sequence.
inline constexpr std::int64_t quasiRandomOrders = 4;
/// From this order on, a path survives every doubling of the order with probability 1/sqrt(2). In a
/// conservative medium the number of scatterings has a tail like n^(-1/2); with this roulette both
/// cost and variance grow like log n.
inline constexpr int firstOrderRoulette = 4096;
/// The same where the medium outside has no end, and no path leaves it. There the number of
/// scatterings needs a finite mean, which a survival below 1/2 gives.
inline constexpr int firstEndlessRoulette = 256;
inline constexpr float endlessSurvival = 0.45f;
/// From this bounce off surfaces on, a path survives each with this probability: light that total
/// reflection keeps in a crystal would never leave it.
inline constexpr int firstBounceRoulette = 256;
inline constexpr float bounceSurvival = 0.95f;
/// Shadow rays end this much, relatively, before a light that is a surface itself.
inline constexpr double beforeLight = 1 - 1e-7;
/// Where such a light may coincide with other surfaces, they end this far behind it.
inline constexpr double behindLight = 1 + 1e-6;

/// The random numbers of one scattering event and of the flight after it.
struct EventNumbers {
    std::array<double, 2> phase, light;
    double flight, pick, equiangular;
};

/// A path's state where the scene has surfaces.
struct SurfaceState {
    NestedMedia::RayStart start;  ///< where the flight starts
    surface::SurfaceHit ahead;    ///< the nearest surface, at tMax
    bool hitsAhead = false;
    double tMax = infinity;
    Rgb tint{1.0f};  ///< colour of surfaces, where the throughput has one channel
    int bounces = 0;
    bool seen = true;  ///< by the camera: the ray has met only boundaries so far
    /// Whether next-event estimation has sampled the light that the path hits.
    enum class LightSampled {
        Never,              ///< it could not choose this direction: the light counts in full
        AtLastEvent,        ///< it could: the light is weighted by multiple importance sampling
        ThroughDielectrics  ///< it did, by transparent shadows: the light does not count
    } lightSampled = LightSampled::Never;
};
struct Nothing {};

template <int N, bool Surfaces>
struct PathState {
    PathResult* result;
    SampleSequence sequence;
    RandomStream random;
    Vec3d origin, direction;
    Spectrum<N> throughput{1.0f};
    Spectrum<N>
        opacity{};  // of absorbing media on the camera's ray: 1 - throughput without rounding
    Rgb radiance;
    std::int64_t scatterings = 0;
    light::ScatterPoint from;  // the last scattering event, for MIS at what its direction hits
    double phasePdf = 0;       // of that direction
    double flight = 1;         // draws the next optical depth
    double equiangular = 0, localLightPick = 0;  // draw its equiangular point, and the light for it
    bool alive = true;
    std::uint8_t mediumSet = 0;  // of approximate media that the flight goes through; 0: none
    [[no_unique_address]] std::conditional_t<Surfaces, SurfaceState, Nothing> surfaces = {};
};

/// Light along one or two straight legs, and the path that it lights. The query carries the
/// medium's channels. The light's colour, its largest channel 1, stays here.
template <bool Surfaces>
struct ShadowRay {
    std::size_t path;
    Rgb colour;
    bool secondLeg = false;
    bool transparent = false;    // passes dielectrics
    bool inFront = false;        // brings light of the camera's first flight, before any surface
    bool withinFlight = false;   // no surface lies in its way
    std::uint8_t mediumSet = 0;  // which media it goes through
    std::uint8_t secondMediumSet = 0;
    std::uint32_t emitter = light::LightSample::none;  // the triangle that it goes to
    Vec3d origin = {}, direction = {};                 // of the second leg
    double tMax = 0;
    [[no_unique_address]] std::conditional_t<Surfaces, NestedMedia::RayStart, Nothing> start = {};
};

}  // namespace woodcock::render
