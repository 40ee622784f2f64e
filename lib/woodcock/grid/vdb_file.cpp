// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb_file.h"

#include <openvdb/openvdb.h>

#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/grid/vdb_header.h"
#include "woodcock/grid/vdb_types.h"

namespace woodcock {

namespace {

GridClass classOf(const openvdb::GridBase& grid) {
    switch (grid.getGridClass()) {
        case openvdb::GRID_LEVEL_SET:
            return GridClass::LevelSet;
        case openvdb::GRID_FOG_VOLUME:
            return GridClass::FogVolume;
        case openvdb::GRID_STAGGERED:
            return GridClass::Staggered;
        default:
            return GridClass::Unknown;
    }
}

/// Through the map's own functions: its affine matrix refuses to exist for voxels below 1e-5.
Affine3d affineOf(const openvdb::math::MapBase& map) {
    const auto vec = [](const openvdb::Vec3d& v) { return Vec3d{v[0], v[1], v[2]}; };
    Affine3d m;
    for (int i = 0; i < 3; ++i) {
        openvdb::Vec3d axis(0.0);
        axis[i] = 1;
        m.column[static_cast<std::size_t>(i)] = vec(map.applyJacobian(axis));
    }
    m.translation = vec(map.applyMap(openvdb::Vec3d(0.0)));
    return m;
}

/// The first reason stands.
void markUnusable(GridListing& listing, std::string reason) {
    if (listing.usable()) listing.unusable = std::move(reason);
}

void describeTransform(const openvdb::math::Transform& transform, GridListing& listing) {
    if (!transform.isLinear()) {
        listing.frustum = true;
        markUnusable(listing,
                     "its transform is a frustum, which is not supported; resample it to a "
                     "linear transform (Houdini: VDB Resample)");
        return;
    }
    const Affine3d m = affineOf(*transform.baseMap());
    const double determinant = m.determinant();
    listing.worldFromIndex = m;
    listing.voxelSize = {length(m.column[0]), length(m.column[1]), length(m.column[2])};
    if (!isFinite(m.translation) || !isFinite(listing.voxelSize) || !std::isfinite(determinant))
        markUnusable(listing, "its transform is not finite");
    else if (determinant == 0)
        markUnusable(listing, "its transform is singular: it flattens all voxels into a plane");
}

void copyMetadata(const openvdb::MetaMap& from, GridListing& listing) {
    for (auto it = from.beginMeta(); it != from.endMeta(); ++it) {
        if (it->first == openvdb::GridBase::META_FILE_DELAYED_LOAD) continue;  // a cache, no news
        const std::string text = it->second->str();
        if (text.size() <= 4096) listing.metadata.emplace_back(it->first, text);
    }
}

void describeMetadata(const openvdb::GridBase& grid, GridListing& listing) {
    listing.name = grid.getName();
    listing.gridClass = classOf(grid);
    copyMetadata(grid, listing);
    if (listing.channels == 0) {
        markUnusable(
            listing,
            fmt::format("grids of {} are not supported; those of float, double, int32, int64, "
                        "bool, mask, vec3s, vec3d and vec3i are",
                        listing.valueType));
    } else if (listing.gridClass == GridClass::LevelSet) {
        markUnusable(listing,
                     "it is a level set (distances, no density); convert it to a fog volume first "
                     "(Houdini: Convert VDB to 'Fog VDB'; Blender: Mesh to Volume; OpenVDB: "
                     "tools::sdfToFogVolume)");
    }
}

GridListing describe(openvdb::io::File& file, const std::string& uniqueName,
                     const std::string& treeType, bool savedAsHalf) {
    GridListing listing;
    listing.name = listing.uniqueName = uniqueName;
    const VdbValueType type = valueTypeOf(treeType);
    listing.valueType = (savedAsHalf ? "half-saved " : "") + type.name;
    listing.channels = type.channels;
    try {
        const openvdb::GridBase::ConstPtr grid = file.readGridMetadata(uniqueName);
        describeMetadata(*grid, listing);
        describeTransform(grid->transform(), listing);
    } catch (const openvdb::Exception& e) {
        markUnusable(listing,
                     fmt::format("its metadata or transform cannot be read ({})", e.what()));
    }
    return listing;
}

std::vector<GridListing> describeAll(openvdb::io::File& file, const VdbHeader& header) {
    std::vector<GridListing> grids;
    for (const VdbHeader::Entry& entry : header.entries) {
        grids.push_back(describe(file, entry.uniqueName, entry.treeType, entry.savedAsHalf));
        grids.back().fileBytes = static_cast<std::uint64_t>(entry.end - entry.begin);
    }
    if (header.hasOffsets) return grids;
    for (auto name = file.beginName(); name != file.endName(); ++name) {
        const openvdb::GridBase::ConstPtr grid = file.readGridMetadata(*name);
        grids.push_back(describe(file, *name, grid->type(), grid->saveFloatAsHalf()));
    }
    return grids;
}

}  // namespace

VdbFile listGrids(const std::filesystem::path& path) {
    const VdbHeader header = readVdbHeader(path);
    VdbFile listed{path,
                   fmt::format("OpenVDB {}.{}, file format {}", header.libraryMajor,
                               header.libraryMinor, header.fileVersion),
                   {}};
    withOpenVdbErrors(path, [&] {
        const OpenVdbTypes types(header);
        openvdb::io::File file(path.string());
        file.setCopyMaxBytes(0);
        file.open();
        listed.grids = describeAll(file, header);
    });
    return listed;
}

std::string describeGrids(const VdbFile& file) {
    std::string text;
    for (const GridListing& grid : file.grids)
        text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", grid.uniqueName, grid.valueType);
    return text.empty() ? "no grids" : text;
}

const char* gridClassName(GridClass gridClass) {
    switch (gridClass) {
        case GridClass::FogVolume:
            return "fog volume";
        case GridClass::LevelSet:
            return "level set";
        case GridClass::Staggered:
            return "staggered";
        case GridClass::Unknown:
            break;
    }
    return "unknown";
}

}  // namespace woodcock
