// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::grid {

/// Value type and number of channels of a tree type: {"float", 1} for "Tree_float_5_4_3"; channels
/// are 0 for a tree that cannot become a field.
struct VdbValueType {
    std::string name;
    int channels = 0;
    std::uint32_t bytes = 0;      ///< of a value in the file
    std::uint32_t halfBytes = 0;  ///< of a value saved as half; 0 for a type that never is
    enum class Leaf { Values, Bits, BitsAndMask } leaf = Leaf::Values;
};
VdbValueType valueTypeOf(const std::string& treeType);

/// The positions of the parts of a tree in a file.
struct VdbLayout {
    std::uint64_t topology = 0;         ///< the tree without the voxels of its leaves
    std::vector<std::uint64_t> leaves;  ///< the voxels of each leaf, in the order of the tree
    std::uint64_t end = 0;
};

/// Walks the tree that begins at the current position, without decompressing anything. OpenVDB
/// trusts the sizes and counts in a file. After this check it can read the tree within bounds, in
/// memory that is bounded by the file's size, and in parallel. Errors: Input, with the place.
/// `compression`: the grid's flags. `type` has channels.
VdbLayout findLayout(FileBytes& file, const VdbValueType& type, std::uint32_t compression,
                     bool savedAsHalf);

}  // namespace woodcock::grid
