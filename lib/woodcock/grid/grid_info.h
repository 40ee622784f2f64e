// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "woodcock/grid/field.h"
#include "woodcock/grid/majorants.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/read_voxels.h"

namespace woodcock::grid {

/// What a user should know about a grid before rendering it.
struct GridInfo {
    /// Optical depth, with the mean value along the diagonal of the bounds, at which the majorants
    /// are measured: they are finer in a denser medium.
    static constexpr double opticalDepth = 10;

    struct Contents {
        GridStatistics statistics;
        std::size_t fieldBytes = 0;  ///< of the renderer's own field
        Storage fieldStorage = Storage::Float;
        std::optional<Box3d> worldBounds;             ///< of the positions of active voxels
        std::optional<MajorantStatistics> majorants;  ///< absent where majorants have no meaning
    };
    GridListing listing;
    std::optional<Contents> contents;  ///< absent for types without values and unreadable voxels
    std::string error;                 ///< why the voxels cannot be read; empty when they can
    std::vector<std::string> remarks;  ///< what may be wrong, the most important first
};

/// Reads the voxels and inspects them; faulty grids are described, not refused.
GridInfo inspectGrid(const VdbFile& file, const GridListing& grid);

}  // namespace woodcock::grid
