// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "woodcock/base/error.h"
#include "woodcock/grid/nanovdb/file.h"
#include "woodcock/grid/vdb/check_grid_head.h"
#include "woodcock/grid/vdb/check_header.h"
#include "woodcock/grid/vdb/check_tree.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::grid {

namespace {

GridClass classFromName(const std::string& name) {
    switch (openvdb::GridBase::stringToGridClass(name)) {
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

/// The first reason is kept.
void markUnusable(GridListing& listing, std::string reason) {
    if (listing.usable()) listing.unusable = std::move(reason);
}

void describeTransform(GridListing& listing) {
    if (listing.frustum) {
        markUnusable(listing,
                     "its transform is a frustum, which is not supported; resample it to a "
                     "linear transform (Houdini: VDB Resample)");
        return;
    }
    const Affine3d& m = *listing.worldFromIndex;
    listing.voxelSize = {length(m.column[0]), length(m.column[1]), length(m.column[2])};
    if (const std::string flaw = flawOf(m); !flaw.empty())
        markUnusable(listing, "its transform " + flaw);
}

void describeUse(GridListing& listing) {
    if (listing.valueType == "points") {
        markUnusable(listing,
                     "it holds points and no values; `woodcock convert IN OUT.vdb` makes a density "
                     "of the points");
    } else if (listing.channels == 0) {
        markUnusable(
            listing,
            fmt::format(
                "grids of {} are not supported; those of float, half, double, int32, int64, "
                "bool, mask, vec3s, vec3d and vec3i are",
                listing.valueType));
    } else if (listing.gridClass == GridClass::LevelSet) {
        markUnusable(listing,
                     "it is a level set (distances, no density); convert it to a fog volume first "
                     "(`woodcock convert IN OUT.vdb`; Houdini: Convert VDB to 'Fog VDB'; Blender: "
                     "Mesh to Volume; OpenVDB: "
                     "tools::sdfToFogVolume)");
    }
}

GridListing describe(FileBytes& file, const VdbHeader::Entry& entry) {
    GridListing listing;
    listing.name = listing.uniqueName = entry.uniqueName;
    const VdbValueType type = valueTypeOf(entry.treeType);
    listing.valueType = (entry.savedAsHalf && type.halfBytes > 0 ? "half-saved " : "") + type.name;
    listing.channels = type.channels;
    listing.fileBytes = entry.end - entry.begin;
    try {
        file.enter(entry.begin, entry.end, fmt::format("grid '{}'", entry.uniqueName));
        VdbGridHead head = readGridHead(file);
        listing.name = std::move(head.name);
        listing.gridClass = classFromName(head.gridClass);
        listing.metadata = std::move(head.metadata);
        listing.frustum = head.frustum;
        listing.worldFromIndex = head.worldFromIndex;
        describeUse(listing);
        describeTransform(listing);
    } catch (const Error& e) {
        markUnusable(listing,
                     fmt::format("its metadata or transform cannot be read ({})", e.what()));
    }
    return listing;
}

GridListing describe(const NanoVdbHead& head) {
    GridListing listing;
    listing.name = head.name;
    listing.valueType = head.valueType;
    listing.channels = head.channels;
    listing.gridClass = head.gridClass;
    listing.fileBytes = head.fileBytes;
    listing.worldFromIndex = head.worldFromIndex;
    if (!head.fault.empty()) {
        listing.worldFromIndex.reset();
        markUnusable(listing, fmt::format("its head cannot be read ({})", head.fault));
        return listing;
    }
    if (head.channels == 0)
        markUnusable(listing, fmt::format("a NanoVDB grid of {} holds no values to render; grids "
                                          "of float, double, int32, int64, vec3s, vec3d, Fp4, Fp8, "
                                          "Fp16 and FpN do",
                                          head.valueType));
    describeUse(listing);
    describeTransform(listing);
    return listing;
}

/// Numbers the grids of one name, and those without a name, as OpenVDB's files do.
void numberNames(std::vector<GridListing>& grids) {
    std::map<std::string, int> total, seen;
    for (const GridListing& grid : grids) ++total[grid.name];
    for (GridListing& grid : grids) {
        grid.uniqueName = grid.name;
        if (total[grid.name] > 1 || grid.name.empty())
            grid.uniqueName += fmt::format("[{}]", seen[grid.name]++);
    }
}

VdbFile listNanoVdb(FileBytes& file) {
    const NanoVdbHeads heads = readNanoVdbHeads(file);
    VdbFile listed{file.path(), heads.version, {}, {}, true};
    for (const NanoVdbHead& head : heads.grids) listed.grids.push_back(describe(head));
    numberNames(listed.grids);
    return listed;
}

}  // namespace

VdbFile listGrids(const std::filesystem::path& path) {
    FileBytes file(path);
    if (isNanoVdb(file)) return listNanoVdb(file);
    const VdbHeader header = readVdbHeader(file);
    VdbFile listed{path,
                   fmt::format("OpenVDB {}.{}, file format {}", header.libraryMajor,
                               header.libraryMinor, header.fileVersion),
                   {},
                   {},
                   false};
    if (!file.doubt().empty())
        listed.warning = fmt::format("{}: {}; it is read as the newest known format", path.string(),
                                     file.doubt());
    for (const VdbHeader::Entry& entry : header.entries)
        listed.grids.push_back(describe(file, entry));
    return listed;
}

std::string describeGrids(const VdbFile& file) {
    std::string text;
    for (const GridListing& grid : file.grids)
        text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", grid.uniqueName, grid.valueType);
    return text.empty() ? "no grids" : text;
}

std::size_t indexOf(const VdbFile& file, const std::string& uniqueName) {
    const auto found =
        std::find_if(file.grids.begin(), file.grids.end(),
                     [&](const GridListing& grid) { return grid.uniqueName == uniqueName; });
    if (found == file.grids.end())
        throw inputError("grid '{}' not found in {}; it has: {}", uniqueName, file.path.string(),
                         describeGrids(file));
    return static_cast<std::size_t>(found - file.grids.begin());
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

}  // namespace woodcock::grid
