// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/scene/description.h"
#include "woodcock/scene/keys/key.h"

namespace woodcock::scene {

/// The keys of a surface that are its shape, of which it has one; and `level_set`, of a file.
std::vector<Key<SurfaceDescription>> shapeKeys();

}  // namespace woodcock::scene
