// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::convert {

/// How the bytes of a NanoVDB file are packed. Every program reads `None`; some lack `Blosc`.
enum class NanoVdbCompression { None, Zip, Blosc };

struct NanoVdbWriteOptions {
    NanoVdbCompression compression = NanoVdbCompression::None;
    /// Floats as Fp16: integers of 16 bits between the least and the greatest value of each leaf.
    bool quantise = false;
};

/// The largest changes of active values by the type of a file's numbers.
struct NanoVdbLoss {
    double absolute = 0, relative = 0;
};

/// Writes grids of float, double and vectors of float, whole or not at all. The same grids give the
/// same bytes. No other thread may use the grids meanwhile: NanoVDB marks their nodes, and restores
/// them. Returns the loss by quantising. Errors: Usage for a grid of another type, or with a
/// transform that is not affine; Failure with the system's reason, and where this build has no
/// NanoVDB.
NanoVdbLoss writeNanoVdb(const std::filesystem::path& file, const grid::VdbGrids& grids,
                         const NanoVdbWriteOptions& options = {});

}  // namespace woodcock::convert
