// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

/// A grid that is legal and as unkind as such grids get.
struct HostileGrid {
    const char* name;
    test::GridSpec grid;
};
std::vector<HostileGrid> hostileGrids();

}  // namespace woodcock::proof
