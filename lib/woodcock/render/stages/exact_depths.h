// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Where the camera ray of a path that has just been spawned loses its light, without chance: by
/// exact optical depths, and at the first surface that does not let it pass. Nothing counts behind
/// a holdout.
template <int N, bool Surfaces>
image::StopSample findExactDepths(const TracedScene& traced, const PathState<N, Surfaces>& p);

}  // namespace woodcock::render
