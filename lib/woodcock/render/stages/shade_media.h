// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Ends a path that leaves the scene. Adds radiance from infinity; images and discs are shared with
/// next-event estimation.
template <int N, bool Surfaces>
void escape(const TracedScene& traced, Batch<N, Surfaces>& batch, PathState<N, Surfaces>& p);

/// Scatters path i at distance `t` of its flight, by that part of the medium: adds next-event
/// estimation, and gives the path its next flight or ends it.
template <int N, bool Surfaces>
void scatter(const TracedScene& traced, Batch<N, Surfaces>& batch, std::size_t i, double t,
             std::size_t part);

}  // namespace woodcock::render
