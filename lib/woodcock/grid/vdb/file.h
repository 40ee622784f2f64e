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

namespace woodcock::grid {

enum class GridClass { Unknown, FogVolume, LevelSet, Staggered };

/// What a file tells about one of its grids before its voxels are read.
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
    /// Why the grid cannot be rendered, and what to do about it; empty where it can.
    std::string unusable;

    bool usable() const { return unusable.empty(); }
};

struct VdbFile {
    std::filesystem::path path;
    std::string version;  ///< "OpenVDB 10.0, file format 224", "NanoVDB 32.4"
    std::string warning =
        {};  ///< that the format is newer than the newest known one; usually empty
    std::vector<GridListing> grids;  ///< in the order of the file
    bool nanoVdb = false;            ///< the file is one of NanoVDB
};

/// Reads the list of grids and their metadata; no voxels. A NanoVDB file is recognised by its first
/// bytes, whatever its name. Errors: Input, naming the file and what is wrong with it. Grids that
/// cannot be used are listed and marked; they are not an error.
VdbFile listGrids(const std::filesystem::path& path);

/// "density (float), velocity (vec3s)"; "no grids" for an empty file.
std::string describeGrids(const VdbFile& file);

/// The index in `file.grids` of the grid of this unique name. Errors: Input, listing the grids.
std::size_t indexOf(const VdbFile& file, const std::string& uniqueName);

const char* gridClassName(GridClass gridClass);  ///< "fog volume", as OpenVDB calls it

}  // namespace woodcock::grid
