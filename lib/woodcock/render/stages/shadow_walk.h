// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Follows all shadow rays of the batch to their lights, and adds what arrives to their paths.
template <int N, bool Surfaces>
void shadowWalk(const TracedScene& traced, Batch<N, Surfaces>& batch);

}  // namespace woodcock::render
