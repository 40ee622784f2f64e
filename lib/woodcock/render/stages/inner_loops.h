// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "woodcock/medium/marching.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/render/approximations.h"

namespace woodcock::render {

/// How rays are marched where approximations.marchStep is above 0.
inline medium::MarchSettings marchSettings(const Approximations& approximations) {
    return {.step = approximations.marchStep, .jackknife = approximations.jackknife};
}

// The two inner loops, by tracking, or by marching where that was chosen.

template <int N>
void findEvents(const Approximations& approximations, const medium::Medium& medium,
                std::span<medium::DistanceQuery<N>> queries, medium::TrackingCounters& counters) {
    if (approximations.marchStep > 0)
        medium::marchDistance<N>(medium, marchSettings(approximations), queries, counters);
    else
        medium::trackDistance<N>(medium, queries, counters);
}

template <int N>
void findTransmittances(const Approximations& approximations, const medium::Medium& medium,
                        std::span<medium::TransmittanceQuery<N>> queries,
                        medium::TrackingCounters& counters) {
    if (approximations.marchStep > 0)
        medium::marchTransmittance<N>(medium, marchSettings(approximations), queries, counters);
    else
        medium::trackTransmittance<N>(medium, queries, counters);
}

}  // namespace woodcock::render
