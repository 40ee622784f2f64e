// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "woodcock/convert/format_table.h"
#include "woodcock/grid/vdb/file.h"
#include "woodcock/grid/vdb/openvdb_grids.h"

namespace woodcock::convert {

/// The grids of a source, between reading and writing.
struct Source {
    grid::VdbGrids grids;
    std::optional<Box3i> box;  ///< of the voxels, where the source was dense
    /// The grids' unique names, where they come from a file that numbers grids of one name.
    std::vector<std::string> uniqueNames = {};
};

void say(const std::function<void(const std::string&)>& log, const std::string& text);

/// Reports the fraction of a stage that is done.
WorkProgress stageOf(const ConvertOptions& options, std::string_view name);

/// Numbers on a regular lattice: their values are remapped, and they are placed as the options
/// say. Errors: Usage where --name is given for several volumes.
Source sourceOf(std::vector<DenseVolume> volumes, const std::filesystem::path& in,
                const ConvertOptions& options);

/// The grids of a file of OpenVDB or NanoVDB.
Source readGridsSource(const std::filesystem::path& in, const ConvertOptions& options);

// Shapes become a density.
Source readMeshSource(const std::filesystem::path& in, const ConvertOptions& options);
Source readPointsSource(const std::filesystem::path& in, const ConvertOptions& options);
/// A PLY file is a mesh where it has faces, else points.
Source readPlySource(const std::filesystem::path& in, const ConvertOptions& options);
/// Turns the level sets among the grids into fog.
void fillLevelSets(grid::VdbGrids& grids, const ConvertOptions& options);

/// Adds the density of a grid of points to the grids. False, with a warning, where it holds no
/// points.
bool addPointGrid(grid::VdbGrids& grids, const grid::VdbFile& file, const grid::GridListing& points,
                  const ConvertOptions& options);

// Writers. `in` is the source's name, which a VDB's metadata tells.
void writeVdbSource(const std::filesystem::path& in, const std::filesystem::path& out,
                    grid::VdbGrids& grids, const ConvertOptions& options);
void writeNanoVdbSource(const std::filesystem::path& in, const std::filesystem::path& out,
                        grid::VdbGrids& grids, const ConvertOptions& options);
/// The one grid of the source, or the one that --grid chooses, on a regular lattice.
void writeDenseSource(const std::filesystem::path& out, Source& source, const DenseWriter& writer,
                      const ConvertOptions& options);

}  // namespace woodcock::convert
