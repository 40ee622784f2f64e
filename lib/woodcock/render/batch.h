// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/medium/emission.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/render/layer_output.h"
#include "woodcock/render/light_choice.h"
#include "woodcock/render/medium_runs.h"
#include "woodcock/render/path_state.h"

namespace woodcock::render {

/// A straight piece of a shadow ray, through one medium.
struct ShadowPiece {
    std::uint32_t shadow;  ///< index in Batch::shadows
    std::uint32_t medium;  ///< number in the MediaTable
    Vec3d origin;
    double length;
};

/// What the stages of one thread work on. The vectors keep their memory from batch to batch.
template <int N, bool Surfaces>
struct Batch {
    static constexpr std::size_t size = 256;       ///< paths at a time
    static constexpr std::size_t laneSize = 1024;  ///< where they are traced to their ends

    explicit Batch(const light::LightSet& lights) : choice(lights) {}

    std::vector<PathState<N, Surfaces>> paths;
    std::vector<medium::DistanceQuery<N>> walks;  ///< the flight of each path
    std::vector<ShadowRay<Surfaces>> shadows;
    std::vector<medium::TransmittanceQuery<N>> shadowQueries;  ///< the ray of each
    LayerOutput layers;
    RenderCounters counters;
    LightChoice choice;
    medium::EmissionSampler emission;

    // Within one stage:
    MediumRuns runs;
    std::vector<medium::DistanceQuery<N>> sortedWalks;
    std::vector<medium::TransmittanceQuery<N>> sortedShadows, absorbed;
    std::vector<ShadowPiece> pieces;
    // Of camera rays, by path, where their stopped light is asked for:
    std::vector<std::vector<medium::FlightCollision>> collisions;
    std::vector<std::vector<medium::DepthNode>> depths;

    void clear() {
        paths.clear(), walks.clear(), shadows.clear(), shadowQueries.clear();
        counters = {};
    }
};

}  // namespace woodcock::render
