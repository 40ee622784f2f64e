// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Grid.h>

namespace woodcock::grid {

/// OpenVDB's grids in memory. Headers only declare it (`struct VdbGrids;`), as OpenVDB's own
/// headers take seconds to compile.
struct VdbGrids {
    openvdb::GridPtrVec grids;
};

}  // namespace woodcock::grid
