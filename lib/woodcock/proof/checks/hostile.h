// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

/// A grid that is valid, and as difficult as possible.
struct HostileGrid {
    const char* name;
    GridSpec grid;
};
std::vector<HostileGrid> hostileGrids();

}  // namespace woodcock::proof
