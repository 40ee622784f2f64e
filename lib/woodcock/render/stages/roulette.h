// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "woodcock/render/path_state.h"

namespace woodcock::render {

/// Throughput below which paths play Russian roulette (absorption is a weight).
inline constexpr float pathRoulette = 0.1f;
/// Shadow rays play it below this part of LightSet::typicalRadiance().
inline constexpr float shadowRoulette = 0.05f;
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

/// To be played after each scattering in a medium; `endless`: in one that fills all of space.
/// False: the path has ended.
template <int N, bool Surfaces>
bool surviveOrder(PathState<N, Surfaces>& p, bool endless) {
    if (p.scatterings >= (endless ? firstEndlessRoulette : firstOrderRoulette) &&
        std::has_single_bit(static_cast<std::uint64_t>(p.scatterings))) {
        if (p.random.uniform() >= (endless ? double{endlessSurvival} : 0.70710678118654752)) {
            p.alive = false;
            return false;
        }
        p.throughput *= endless ? 1 / endlessSurvival : 1.41421356f;
    }
    return true;
}

/// To be played after each bounce off a surface, by a path of this weight (largest channel).
template <int N>
void surviveBounce(PathState<N, true>& p, float weight) {
    float survival = std::min(1.0f, weight / pathRoulette);
    if (p.surfaces.bounces >= firstBounceRoulette) survival *= bounceSurvival;
    if (survival >= 1) return;
    if (p.random.uniform() >= survival)
        p.alive = false;
    else
        p.throughput *= 1 / survival;
}

}  // namespace woodcock::render
