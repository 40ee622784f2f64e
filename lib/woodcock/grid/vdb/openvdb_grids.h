// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

namespace woodcock {

/// OpenVDB's grids in memory, on their way from one source file of grid/ or bake/ to another.
/// Headers only name it (`struct VdbGrids;`), as OpenVDB's own take seconds to compile.
struct VdbGrids {
    openvdb::GridPtrVec grids;
};

}  // namespace woodcock
