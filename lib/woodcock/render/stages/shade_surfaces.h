// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// What happens to path i at the surface that ends its flight: it goes on behind a boundary that
/// changes only the medium, bounces, or ends.
template <int N>
void meetSurface(const TracedScene& traced, Batch<N, true>& batch, std::size_t i);

}  // namespace woodcock::render
