// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Takes paths that have ended out of the batch, and hands in what they found.
template <int N, bool Surfaces>
void retire(const TracedScene& traced, Batch<N, Surfaces>& batch);

}  // namespace woodcock::render
