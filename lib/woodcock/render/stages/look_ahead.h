// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/batch.h"
#include "woodcock/render/traced_scene.h"

namespace woodcock::render {

/// Finds what flights need before they are tracked: the medium around each and the surface at its
/// end. Adds shadow rays for the emission along it, and for the equiangular point on it.
template <int N, bool Surfaces>
void lookAhead(const TracedScene& traced, Batch<N, Surfaces>& batch);

}  // namespace woodcock::render
