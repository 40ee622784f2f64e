// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace woodcock {

/// What a .vdb file says before its first grid: enough to tell what is wrong with a file that
/// OpenVDB would read as garbage, or refuse whole because of one grid of an unknown type.
struct VdbHeader {
    struct Entry {
        std::string uniqueName;  ///< "density", "density[1]"
        std::string treeType;    ///< "Tree_float_5_4_3"
        bool savedAsHalf = false;
        std::int64_t begin = 0, end = 0;  ///< bytes of the file that hold the grid
    };
    std::uint32_t fileVersion = 0, libraryMajor = 0, libraryMinor = 0;
    bool hasOffsets = false;     ///< else written as a stream, and `entries` stays empty
    std::vector<Entry> entries;  ///< in the order of the file
};

/// Errors: Input when the file is missing, a directory, no VDB file, of an unknown version or cut
/// short.
VdbHeader readVdbHeader(const std::filesystem::path& file);

}  // namespace woodcock
