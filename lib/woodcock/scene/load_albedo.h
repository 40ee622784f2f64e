// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/grid/vdb/load_field.h"

namespace woodcock::scene {

/// Sees to it that an albedo grid, loaded as `field`, holds nothing above 1: throws Error{Input}
/// with the count of such voxels, or, where the options say repair, sets them to 1 and returns a
/// note. Empty where there was nothing to do.
std::string limitAlbedo(const grid::VdbFile& file, const grid::GridListing& grid,
                        const grid::LoadOptions& options, grid::Field& field);

}  // namespace woodcock::scene
