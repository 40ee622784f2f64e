// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "woodcock/convert/convert.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/file.h"

namespace woodcock {

/// What a source holds, on its way to the file that is written.
struct Source {
    VdbGrids grids;
    std::optional<Box3i> box;  ///< of the voxels, where the source was dense
    /// Of the grids, where they come from a file that tells its grids apart by name and number.
    std::vector<std::string> uniqueNames = {};
};

void say(const std::function<void(const std::string&)>& log, const std::string& text);

/// What tells the share of a stage that is done.
WorkProgress stageOf(const ConvertOptions& options, std::string_view name);

// Numbers on a lattice: values remapped, and placed as the options say.
Source readRawSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readNpySource(const std::filesystem::path& in, const ConvertOptions& options);
Source readNpzSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readMitsubaSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readNrrdSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readImagesSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readPagesSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readPbrtSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readImageFilesSource(const std::vector<std::filesystem::path>& in,
                            const ConvertOptions& options);

/// The grids of a file of OpenVDB or NanoVDB.
Source readGridsSource(const std::filesystem::path& in, const ConvertOptions& options);

// Shapes become density.
Source readMeshSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readPointsSource(const std::filesystem::path& in, const ConvertOptions& options);
/// A PLY file is a mesh where it has faces, else points.
Source readPlySource(const std::filesystem::path& in, const ConvertOptions& options);
/// Those of the grids that are level sets become fog.
void fillLevelSets(VdbGrids& grids, const ConvertOptions& options);

/// The density of a grid of points becomes one of the grids; false, with a warning, where it holds
/// none.
bool addPointGrid(VdbGrids& grids, const VdbFile& file, const GridListing& points,
                  const ConvertOptions& options);

}  // namespace woodcock
