// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "woodcock/grid/nanovdb/buffer.h"
#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::grid {

enum class NanoCodec : std::uint16_t { None, Zip, Blosc };

/// Where a NanoVDB file keeps a grid.
struct NanoListing {
    std::string name;
    std::uint64_t begin = 0, stored = 0;  ///< its bytes in the file
    std::uint64_t size = 0;               ///< in memory, unpacked
    std::uint32_t version = 0;            ///< of its segment
    NanoCodec codec = NanoCodec::None;
};

/// All grids of the file, the places of which lie inside it. Errors: Input.
std::vector<NanoListing> listNanoGrids(FileBytes& file);

/// The bytes of a grid as NanoVDB has them in memory; nothing is known of what they are.
/// Errors: Input; Failure where they do not fit into memory.
NanoBuffer unpackNanoGrid(FileBytes& file, const NanoListing& grid);

/// The first `bytes` of them, or fewer where there are no more. Errors: Input.
NanoBuffer unpackNanoHead(FileBytes& file, const NanoListing& grid, std::uint64_t bytes);

}  // namespace woodcock::grid
