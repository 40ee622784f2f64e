// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Takes every path along its flight: batch.walks[i] says where path i scatters next, or that it
/// reaches the flight's end.
template <int N, bool Surfaces>
void walk(const TracedScene& traced, Batch<N, Surfaces>& batch);

}  // namespace woodcock::render
