// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/vec.h"

namespace woodcock::proof {

/// Points makes an empty point grid: a type that holds no voxel values. Half is OpenVDB 13's.
enum class VdbType { Float, Half, Double, Int32, Int64, Bool, Mask, Vec3s, Vec3d, Vec3i, Points };

/// Scalars use the first of three components.
using VdbValue = std::array<double, 3>;

struct VdbVoxel {
    Vec3i at;
    VdbValue value{};
    bool active = true;
};

/// `size` is 8, 128 or 4096; `origin` a multiple of it.
struct VdbTile {
    Vec3i origin;
    int size = 8;
    VdbValue value{};
    bool active = true;
};

/// One grid of a file for a test: made of tiles, then of a function over a box, then of voxels.
struct GridSpec {
    std::string name = "density";
    VdbType type = VdbType::Float;
    VdbValue background{};
    std::vector<VdbTile> tiles{};
    /// Where `value` or `colour` is evaluated; voxels equal to the background are not set.
    Box3i box{};
    std::function<double(Vec3i)> value{};
    std::function<Vec3d(Vec3i)> colour{};
    std::vector<VdbVoxel> voxels{};
    Affine3d worldFromIndex{};
    std::string gridClass = "fog volume";  ///< or "unknown", "level set", "staggered"
    bool saveAsHalf = false;
    bool frustum = false;  ///< a tapered frustum transform instead of `worldFromIndex`
    std::vector<std::pair<std::string, std::string>> metadata{};
};

enum class VdbCompression { None, Zip, Blosc };

/// Writes the grids in the given order (names may repeat); as format 225 where one is of halves.
void writeVdb(const std::filesystem::path& file, const std::vector<GridSpec>& grids,
              VdbCompression compression = VdbCompression::Blosc);

/// As a pipe would be fed: without the table of offsets that lets a reader skip grids.
void streamVdb(const std::filesystem::path& file, const std::vector<GridSpec>& grids);

/// Changes the number of the file's format.
void setVdbFormat(const std::filesystem::path& file, std::uint32_t number);

/// Cuts the file after `bytes` bytes.
void truncateFile(const std::filesystem::path& file, std::uintmax_t bytes);

/// Overwrites every occurrence of `from` by `to`, of the same length; throws where there is none.
void patchFile(const std::filesystem::path& file, const std::string& from, const std::string& to);

}  // namespace woodcock::proof
