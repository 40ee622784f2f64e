// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Adds the path of a job, on its camera ray, to the batch. `result` must outlive the path.
template <int N, bool Surfaces>
void spawn(const TracedScene& traced, Batch<N, Surfaces>& batch, const PathJob& job,
           PathResult& result);

}  // namespace woodcock::render
