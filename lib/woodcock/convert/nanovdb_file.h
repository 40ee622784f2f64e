// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace woodcock {

struct VdbGrids;

/// Whether this build can read and write NanoVDB files: it was made with NanoVDB's headers.
bool hasNanoVdb();

/// All grids of a NanoVDB file, with their names, transforms and classes; a file keeps no other
/// metadata. Scalars (float, double, integers of 32 and 64 bits, the quantised Fp4, Fp8, Fp16 and
/// FpN) become float, vectors of float or double become vectors of float. The file is not trusted:
/// all sizes and places in it are checked. Errors: Input, naming file, grid and what is wrong;
/// Failure where it does not fit into memory or this build has no NanoVDB.
VdbGrids readNanoVdb(const std::filesystem::path& file);

/// Writes grids of float and of vectors of float, uncompressed, whole or not at all. The same grids
/// give the same bytes. No other thread may use the grids meanwhile: NanoVDB marks their nodes, and
/// restores them. Errors: Usage for a grid of another type, or with a transform that is not affine;
/// Failure with the system's reason, and where this build has no NanoVDB.
void writeNanoVdb(const std::filesystem::path& file, const VdbGrids& grids);

}  // namespace woodcock
