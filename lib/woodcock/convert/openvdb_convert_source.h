// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "woodcock/convert/convert.h"
#include "woodcock/grid/openvdb_grids.h"

namespace woodcock {

/// What a source holds, on its way to the file that is written.
struct Source {
    VdbGrids grids;
    std::optional<Box3i> box;  ///< of the voxels, where the source was dense
};

void say(const std::function<void(const std::string&)>& log, const std::string& text);

// Shapes become density.
Source readMeshSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readPointsSource(const std::filesystem::path& in, const ConvertOptions& options);
/// A PLY file is a mesh where it has faces, else points.
Source readPlySource(const std::filesystem::path& in, const ConvertOptions& options);
/// Those of the grids that are level sets become fog.
void fillLevelSets(VdbGrids& grids, const ConvertOptions& options);

}  // namespace woodcock
