// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock::medium {

struct Medium;

/// The two inner loops: distance and transmittance. Each takes an array of rays, each with a time
/// and a random stream of its own. They do not depend on lights, materials or film.

/// Work done, for measuring.
struct TrackingCounters {
    std::uint64_t segments = 0, collisions = 0;  ///< collisions include null ones
};

// How the light of a ray falls along its way, for queries that ask for it. It changes nothing else.

/// A tentative collision of a flight: what is left of the ray's light behind it, as a mean over the
/// channels; roulette is thought of. In order of t. Beyond the last one nothing changes.
struct FlightCollision {
    double t;
    int part;  ///< of the medium, that has stopped what is gone
    float left;
};

/// Optical depth of one part alone over [0, t] of a ray. The nodes of a part are in order of t.
/// Between two of them it grows evenly; two nodes at one t are a jump. Before the first node it is
/// 0, and behind the last it stays.
struct DepthNode {
    double t;
    int part;
    Rgb depth;  ///< infinite where nothing gets through
};

/// Where does a path that goes on from `origin` scatter next?
template <int N>
struct DistanceQuery {
    Vec3d origin, direction;  ///< world space, direction of unit length
    double tMax;              ///< length of the ray; infinity: until it leaves the medium
    float time = 0;           ///< of the ray, within the shutter: see look_up.h
    double u;  ///< in (0, 1]: draws the first optical depth; the stream draws the rest
    RandomStream random;
    float roulette = 0;          ///< throughput below which Russian roulette is played; 0: never
    bool absorptionToo = false;  ///< absorption is an event too, not a weight
    std::vector<FlightCollision>* collisions = nullptr;  ///< where to note them; null: nowhere
    // In and out:
    Spectrum<N> throughput;  ///< multiplied by the weight of what happened; all zero: path ended
    // Out:
    double t = 0;   ///< distance of the scattering event
    int part = -1;  ///< which part of the medium scatters there; -1: reached tMax
};

/// Weighted null-collision tracking with local majorants: Galtier et al. 2013; weights for the
/// channels as in Novak et al. 2018 ("Monte Carlo Methods for Volumetric Light Transport
/// Simulation"), sec. 5.2; see tracking.cpp for the collision probabilities.
template <int N>
void trackDistance(const Medium& medium, std::span<DistanceQuery<N>> queries,
                   TrackingCounters& counters);

/// How much of `contribution` passes [0, tMax] of the ray?
template <int N>
struct TransmittanceQuery {
    Vec3d origin, direction;
    double tMax;
    float time = 0;
    RandomStream random;
    /// Below this (largest channel) Russian roulette is played, in one draw for the whole ray.
    float roulette = 0;
    // In and out: multiplied by an unbiased estimate of the transmittance.
    Spectrum<N> contribution;
    bool opacityToo = false;
    std::vector<DepthNode>* depthAlong = nullptr;  ///< where to note it; null: nowhere
    // Out, where it is asked for: 1 - transmittance, with all digits where it is small.
    Spectrum<N> opacity{};
};

/// Residual ratio tracking with each cell's lower bound as control: Novak et al. 2014, eq. 13.
template <int N>
void trackTransmittance(const Medium& medium, std::span<TransmittanceQuery<N>> queries,
                        TrackingCounters& counters);

}  // namespace woodcock::medium
