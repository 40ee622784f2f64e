// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

#include "woodcock/grid/field.h"

namespace woodcock::bake {

/// A field with the values of a float or vec3s grid in memory.
grid::Field fieldOf(const openvdb::GridBase& grid);

}  // namespace woodcock::bake
