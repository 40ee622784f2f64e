// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "woodcock/render/path_state.h"

namespace woodcock::render {

/// The random numbers of one scattering event and of the flight after it.
struct EventNumbers {
    std::array<double, 2> phase, light;
    double flight, pick, equiangular;
};

/// The first scattering orders take their numbers from the quasi-random sequence.
inline constexpr std::int64_t quasiRandomOrders = 4;

/// The time of a path, uniform within the shutter and stratified over a pixel's samples. It has a
/// set of dimensions of its own, so nothing else is drawn otherwise in a scene that moves.
inline float drawTime(const SampleSequence& sequence) {
    constexpr std::uint32_t set = 2 * quasiRandomOrders + 1;  // the first that no event has
    return static_cast<float>(sequence.draw(set)[0]);
}

/// The numbers of a path's next event.
template <int N, bool Surfaces>
[[gnu::always_inline]] inline EventNumbers drawNumbers(PathState<N, Surfaces>& p) {
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

/// Only those of the turn and the flight of one of the first orders, where nothing else needs any.
template <int N>
[[gnu::always_inline]] inline void drawTurnNumbers(const PathState<N, false>& p,
                                                   EventNumbers& numbers) {
    const auto u = p.sequence.draw(static_cast<std::uint32_t>(2 * p.scatterings + 1));
    numbers.phase = {u[0], u[1]}, numbers.flight = 1 - u[2];
}

}  // namespace woodcock::render
