// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "woodcock/bake/node.h"
#include "woodcock/base/affine.h"
#include "woodcock/grid/field.h"

namespace woodcock::bake {

/// A field's trilinear interpolation as a node. At the positions of its own voxels it gives exactly
/// their values.
std::shared_ptr<const Node> gridNode(grid::Field field, const Affine3d& worldFromIndex);

}  // namespace woodcock::bake
