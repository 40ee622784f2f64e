// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/vec.h"

namespace woodcock {

enum class GridClass { Unknown, FogVolume, LevelSet, Staggered };

/// What a file says about one of its grids without its voxels being read.
struct GridListing {
    std::string name;        ///< may be empty, and may be shared by other grids of the file
    std::string uniqueName;  ///< `name`, or `name[2]` where the file holds several of that name
    std::string valueType;   ///< "float", "half-saved float", "vec3s", "points", ...
    int channels = 0;        ///< 1 or 3; 0 for a type that holds no numbers
    GridClass gridClass = GridClass::Unknown;
    std::optional<Affine3d> worldFromIndex;  ///< absent for a frustum or an unreadable transform
    bool frustum = false;
    Vec3d voxelSize;  ///< lengths of the images of the axes, world units
    std::vector<std::pair<std::string, std::string>>
        metadata;  ///< sorted by key, large blobs left out
    std::uint64_t fileBytes = 0;
    /// Why the grid cannot be rendered, with what to do instead; empty when it can.
    std::string unusable;

    bool usable() const { return unusable.empty(); }
};

struct VdbFile {
    std::filesystem::path path;
    std::string version;             ///< "OpenVDB 10.0, file format 224", "NanoVDB 32.4"
    std::string warning = {};        ///< of a format newer than any that is known; usually empty
    std::vector<GridListing> grids;  ///< in the order of the file
    bool nanoVdb = false;            ///< the file is one of NanoVDB
};

/// Reads the list of grids and their metadata; no voxels. A file of NanoVDB is known by how it
/// begins, whatever its name.
/// Errors: Input, naming the file and what is wrong with it. Grids that cannot be used are listed
/// and marked, they are no error.
VdbFile listGrids(const std::filesystem::path& path);

/// "density (float), velocity (vec3s)"; "no grids" for an empty file.
std::string describeGrids(const VdbFile& file);

/// Where in `file.grids` the grid of this unique name is. Errors: Input, listing what there is.
std::size_t indexOf(const VdbFile& file, const std::string& uniqueName);

const char* gridClassName(GridClass gridClass);  ///< "fog volume", as OpenVDB calls it

}  // namespace woodcock
