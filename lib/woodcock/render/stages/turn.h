// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "woodcock/medium/phase.h"
#include "woodcock/render/path_state.h"

namespace woodcock::render {

/// Samples the path's next direction. Weights the path where the phase function differs between the
/// channels.
template <int N, bool Surfaces>
medium::PhaseSample turn(PathState<N, Surfaces>& p, const medium::PhaseFunction& phase,
                         const std::array<double, 2>& u) {
    if constexpr (N == 3)
        if (phase.chromatic()) {
            const Rgb before = toRgb(p.throughput);
            const medium::PhaseSample s = phase.sampleMixed(p.direction, before, u[0], u[1]);
            p.throughput *= phase.mixed(dot(p.direction, s.direction), before).weight;
            return s;
        }
    return phase.sample(p.direction, u[0], u[1]);
}

}  // namespace woodcock::render
