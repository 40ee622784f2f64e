// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include "woodcock/base/affine.h"
#include "woodcock/grid/field.h"

namespace woodcock {

/// A field with the values of a float or vec3s grid in memory.
Field fieldOf(const openvdb::GridBase& grid);

/// The grid's transform, which must be affine.
Affine3d worldFromIndexOf(const openvdb::GridBase& grid);

/// The grid's transform is made to be this one.
void setTransform(openvdb::GridBase& grid, const Affine3d& worldFromIndex);

}  // namespace woodcock
