// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::grid {

/// The head of a grid: everything before its tree.
struct VdbGridHead {
    std::uint32_t compression = 0;  ///< OpenVDB's flags
    /// Sorted by key, as text; large ones and OpenVDB's cache of sizes left out.
    std::vector<std::pair<std::string, std::string>> metadata;
    std::string name, gridClass;  ///< as the metadata have them
    bool savedAsHalf = false;
    bool frustum = false;  ///< then `worldFromIndex` is absent
    std::optional<Affine3d> worldFromIndex;
};

/// Reads the head at the current position and stops where the tree begins. Errors: Input.
VdbGridHead readGridHead(FileBytes& file);

}  // namespace woodcock::grid
