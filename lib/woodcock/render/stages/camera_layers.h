// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Fills in p.result->depth for a path that has just been spawned: the transmittance of its camera
/// ray, and the first thing that it meets, by a separate walk. `place`: null, or filled in as well.
template <int N, bool Surfaces>
void sampleCameraLayers(const TracedScene& traced, const PathState<N, Surfaces>& p,
                        image::PlaceSample* place);

}  // namespace woodcock::render
