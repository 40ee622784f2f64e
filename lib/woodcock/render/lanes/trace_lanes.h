// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/lanes/lane_scene.h"

namespace woodcock::render {

/// Traces the paths of a batch to their ends, all as they were spawned, with a path in each lane of
/// the processor's vectors. What is left to do of them are the shadow rays that were added.
///
/// The walk, its collisions and the turns are those of medium/tracking.h, of phase.h and of
/// shade_media.h, in single precision: a position is the corner of its majorant cell and a float
/// within it. A path's numbers are its own. So neither the batch nor the length of vectors changes
/// a bit.
template <int N>
void traceLanes(const LaneScene& scene, Batch<N, false>& batch);

}  // namespace woodcock::render
