// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "tools/info/report.h"

namespace woodcock::tool {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json json(Vec3<T> v) {
    return {v.x, v.y, v.z};
}

/// A number for scalars, three for vectors; NaN and infinities become null.
template <class T>
Json json(const std::array<T, 3>& v, int channels) {
    if (channels == 1) return v[0];
    return {v[0], v[1], v[2]};
}

Json matrix(const Affine3d& m) {
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back({m.column[0][row], m.column[1][row], m.column[2][row], m.translation[row]});
    rows.push_back({0.0, 0.0, 0.0, 1.0});
    return rows;
}

Json json(const grid::VoxelCount& voxels) {
    if (voxels.count == 0) return {{"count", 0}};
    return {{"count", voxels.count}, {"first", json(voxels.first)}};
}

void addContents(const grid::GridInfo::Contents& contents, int channels, Json& to) {
    const grid::GridStatistics& statistics = contents.statistics;
    const grid::VoxelScan& voxels = statistics.voxels;
    if (const Box3i& box = statistics.activeBounds; !box.empty())
        to["index_bounds"] = {json(box.lower), json(box.upper)};
    if (contents.worldBounds)
        to["world_bounds"] = {json(contents.worldBounds->lower), json(contents.worldBounds->upper)};
    to["active_voxels"] = voxels.active;
    to["active_tiles"] = statistics.activeTiles;
    to["leaves"] = statistics.leaves;
    to["inactive_values"] = voxels.inactiveValues;
    to["background"] = json(statistics.background, channels);
    if (voxels.finite > 0) {
        to["min"] = json(voxels.min, channels);
        to["max"] = json(voxels.max, channels);
        to["mean"] = json(std::array{voxels.mean(0), voxels.mean(1), voxels.mean(2)}, channels);
    }
    to["nan"] = json(voxels.nan);
    to["infinite"] = json(voxels.infinite);
    to["negative"] = json(voxels.negative);
    to["openvdb_bytes"] = statistics.openVdbBytes;
    to["field_bytes"] = contents.fieldBytes;
    to["field_storage"] = contents.fieldStorage == grid::Storage::Half ? "half" : "float";
    if (const auto& majorants = contents.majorants)
        to["majorants"] = {{"optical_depth", grid::GridInfo::opticalDepth},
                           {"rays", majorants->rays},
                           {"segments_per_ray", majorants->segmentsPerRay},
                           {"segments_per_ray_error", majorants->segmentsError},
                           {"majorant_over_mean", majorants->majorantOverMean},
                           {"majorant_over_mean_error", majorants->majorantOverMeanError}};
}

Json json(const grid::GridInfo& info) {
    const grid::GridListing& grid = info.listing;
    Json j{{"name", grid.name},
           {"unique_name", grid.uniqueName},
           {"type", grid.valueType},
           {"class", grid::gridClassName(grid.gridClass)},
           {"usable", grid.usable()}};
    if (!grid.usable()) j["unusable"] = grid.unusable;
    if (grid.worldFromIndex) {
        j["voxel_size"] = json(grid.voxelSize);
        j["world_from_index"] = matrix(*grid.worldFromIndex);
    }
    if (grid.frustum) j["frustum"] = true;
    if (grid.fileBytes > 0) j["file_bytes"] = grid.fileBytes;
    if (info.contents) addContents(*info.contents, grid.channels, j);
    if (!info.error.empty()) j["error"] = info.error;
    j["remarks"] = info.remarks;
    Json metadata = Json::object();
    for (const auto& [key, text] : grid.metadata) metadata[key] = text;
    j["metadata"] = std::move(metadata);
    return j;
}

}  // namespace

nlohmann::ordered_json infoJson(const std::vector<FileInfo>& files) {
    Json list = Json::array();
    for (const FileInfo& file : files) {
        Json j{{"file", file.path.string()}};
        if (!file.error.empty()) {
            j["error"] = file.error;
        } else {
            j["version"] = file.version;
            if (!file.warning.empty()) j["warning"] = file.warning;
            j["bytes"] = file.bytes;
            j["grids"] = Json::array();
            for (const grid::GridInfo& grid : file.grids) j["grids"].push_back(json(grid));
        }
        list.push_back(std::move(j));
    }
    return {{"files", std::move(list)}};
}

}  // namespace woodcock::tool
