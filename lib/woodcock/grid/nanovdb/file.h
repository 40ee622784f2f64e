// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::grid {

struct VdbGrids;

/// Whether this build can read and write NanoVDB files: it was made with NanoVDB's headers.
bool hasNanoVdb();

/// Whether the file begins as NanoVDB files do, in either byte order.
bool isNanoVdb(FileBytes& file);

/// The head of a grid.
struct NanoVdbHead {
    std::string name;
    std::string valueType;  ///< as OpenVDB calls it, where it has one; "Fp8" and so on else
    int channels = 0;       ///< 1 or 3; 0 for a type that holds no numbers
    GridClass gridClass = GridClass::Unknown;
    Affine3d worldFromIndex;
    std::uint64_t fileBytes = 0;
    std::string fault;  ///< why the head could not be read; empty: it is sound
};

struct NanoVdbHeads {
    std::string version;             ///< "NanoVDB 32.4"
    std::vector<NanoVdbHead> grids;  ///< in the order of the file
};

/// The heads of all grids; no voxels are read. Errors: Input where the file is not a NanoVDB file
/// or is damaged; Failure where this build has no NanoVDB.
NanoVdbHeads readNanoVdbHeads(FileBytes& file);

/// The grid of this index in the file, with its name, transform and class; a file has no other
/// metadata. Quantised floats (Fp4, Fp8, Fp16 and FpN) become floats; other types stay. The file is
/// not trusted: all of its sizes and offsets are checked. Errors: Input, naming file, grid and what
/// is wrong; Failure where it does not fit into memory or this build has no NanoVDB.
VdbGrids readNanoVdbGrid(const std::filesystem::path& file, std::size_t index);

}  // namespace woodcock::grid
