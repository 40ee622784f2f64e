// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::grid {

/// The table of contents of a .vdb file.
struct VdbHeader {
    struct Entry {
        std::string uniqueName;  ///< "density", "density[1]"
        std::string treeType;    ///< "Tree_float_5_4_3"
        bool savedAsHalf = false;
        std::string treeOf;                ///< the grid whose tree it shares; empty: it has its own
        std::uint64_t begin = 0, end = 0;  ///< bytes of the file that hold the grid
    };
    std::uint32_t fileVersion = 0, libraryMajor = 0, libraryMinor = 0;
    bool hasOffsets = false;     ///< else written as a stream: entries are found by walking
    std::vector<Entry> entries;  ///< in the order of the file
};

/// If the format is newer than the newest known one, it reads what it can, and file.doubt() says
/// so. Errors: Input for a file that is not a VDB, is too old, is cut short, or was written as a
/// stream with a grid that cannot be skipped.
VdbHeader readVdbHeader(FileBytes& file);

}  // namespace woodcock::grid
