// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/grid_info.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/load_field.h"

namespace woodcock::grid {

namespace {

constexpr int majorantRays = 4096;

double voxelsIn(const Box3i& box) {
    double n = 1;
    for (int i = 0; i < 3; ++i) n *= 1.0 + box.upper[i] - box.lower[i];
    return n;
}

std::optional<MajorantStatistics> measureMajorants(const Field& field,
                                                   const GridStatistics& statistics) {
    const double mean = statistics.voxels.mean();
    if (field.range().min < 0 || !(mean > 0) || field.support().empty()) return {};
    MajorantGrid::Options options;
    options.depthPerVoxel = GridInfo::opticalDepth / (mean * length(field.support().size()));
    return majorantStatistics(field, MajorantGrid(field, options), majorantRays);
}

GridInfo::Contents inspectContents(const VdbFile& file, const GridListing& grid) {
    const GridSource source = readGridSource(file, grid, {.faulty = true, .negative = false});
    GridInfo::Contents contents;
    contents.statistics = source.statistics;
    const Field field = buildField(
        source.field, source.statistics.voxels.exactAsHalf ? Storage::Half : Storage::Float);
    contents.fieldBytes = field.bytes();
    contents.fieldStorage = field.storage();
    const Box3i& active = source.statistics.activeBounds;
    if (grid.worldFromIndex && !active.empty())
        contents.worldBounds =
            grid.worldFromIndex->box({active.lower.as<double>(), active.upper.as<double>()});
    contents.majorants = measureMajorants(field, source.statistics);
    return contents;
}

void remarkOnValues(const GridListing& grid, const GridStatistics& statistics,
                    std::vector<std::string>& remarks) {
    const VoxelScan& voxels = statistics.voxels;
    const bool coefficient = grid.channels == 1 && grid.gridClass != GridClass::LevelSet;
    if (const std::string faults = describeFaults(statistics, coefficient); !faults.empty())
        remarks.push_back("it holds " + faults + ", which rendering refuses without --repair");
    if (voxels.active == 0) {
        remarks.push_back("it has no active voxels");
    } else if (voxels.finite > 0) {
        const auto channels = static_cast<std::size_t>(grid.channels);
        const bool constant =
            std::equal(voxels.min.begin(), voxels.min.begin() + channels, voxels.max.begin());
        if (constant && voxels.active > 1 && grid.channels == 1 && grid.valueType != "bool" &&
            grid.valueType != "mask")
            remarks.push_back(fmt::format("all of its active voxels are {}", voxels.min[0]));
        const float largest = *std::max_element(voxels.max.begin(), voxels.max.begin() + channels);
        if (largest > 65504.0f)
            remarks.push_back(
                fmt::format("values up to {} exceed the range of half storage (65504)", largest));
    }
    if (voxels.inactiveValues > 0)
        remarks.push_back(
            fmt::format("{} inactive voxels differ from the background; they are "
                        "rendered as well",
                        voxels.inactiveValues));
    if (statistics.background != std::array<float, 3>{} && grid.gridClass != GridClass::LevelSet)
        remarks.push_back(
            "its background is not zero: as a medium it is drawn within the bounds of its active "
            "voxels, unless a scene asks for more (background = \"endless\")");
}

void remarkOnShape(const GridListing& grid, const GridStatistics& statistics,
                   std::vector<std::string>& remarks) {
    const Box3i& box = statistics.activeBounds;
    if (!box.empty()) {
        const double share = static_cast<double>(statistics.voxels.active) / voxelsIn(box);
        if (voxelsIn(box) > 1e9 && share < 1e-5)
            remarks.push_back(
                fmt::format("its bounds are huge: only {:.1e} of them is active; are "
                            "there stray voxels?",
                            share));
    }
    if (grid.gridClass == GridClass::Staggered)
        remarks.push_back("it is staggered: its values belong to the faces of voxels");
}

}  // namespace

GridInfo inspectGrid(const VdbFile& file, const GridListing& grid) {
    GridInfo info;
    info.listing = grid;
    if (!grid.usable()) info.remarks.push_back("it cannot be rendered: " + grid.unusable);
    if (grid.channels == 0) return info;
    try {
        info.contents = inspectContents(file, grid);
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Input) throw;
        info.error = e.what();
        return info;
    }
    remarkOnValues(grid, info.contents->statistics, info.remarks);
    remarkOnShape(grid, info.contents->statistics, info.remarks);
    return info;
}

}  // namespace woodcock::grid
