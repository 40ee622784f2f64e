// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/convert/sample_type.h"
#include "woodcock/convert/work_progress.h"

namespace woodcock::convert {

using Dims = std::array<std::int64_t, 3>;

/// Numbers on a regular lattice, as in a file: bytes in memory, and the position among them of
/// voxel (i, j, k), channel c. So no copy is needed for another order of axes, byte order or type;
/// a number is converted when it is read.
///
/// A value belongs to a point, not to a cell: voxel (i, j, k) lies at worldFromIndex.point(i, j,
/// k), as in a VDB. In formats of cells in a box, the points are the cells' centres.
struct DenseVolume {
    std::string name = "density";
    Dims dims{};
    int channels = 1;
    SampleType type = SampleType::F32;
    bool swapped = false;    ///< the byte order is not the machine's
    double unit = 1;         ///< the values are samples x unit: 1/255 for bytes that mean 0 to 1
    std::int64_t first = 0;  ///< the sample of voxel (0, 0, 0), channel 0
    Dims stride{};           ///< from voxel to voxel, in samples
    std::int64_t channelStride = 1;
    const char* samples = nullptr;
    std::shared_ptr<const void> owner;  ///< of the samples
    Affine3d worldFromIndex;
    bool placed = false;    ///< the file says where the voxels lie
    bool unitCube = false;  ///< not placed, and meant to fill the unit cube
    /// What the channels are, where each is a volume of its own ("times"). Empty: together they are
    /// a colour or vector.
    std::string list;
    std::vector<std::string> notes;  ///< for the user: what was assumed while reading

    std::uint64_t voxels() const {
        return static_cast<std::uint64_t>(dims[0]) * static_cast<std::uint64_t>(dims[1]) *
               static_cast<std::uint64_t>(dims[2]);
    }
    /// "64 x 64 x 32 voxels of u16", with the channels where there are several.
    std::string describe() const;

    /// Channels innermost, then x, y and z: the order of most formats.
    void setStridesXFirst();
    /// Channels innermost, then z, y and x: as arrays in C.
    void setStridesZFirst();
};

/// The most voxels along an axis: index positions are 32-bit numbers in VDB.
inline constexpr std::int64_t mostVoxelsOfSide = 1 << 30;

/// Bytes of dims x channels samples. Absent where a number is not positive or too large.
std::optional<std::uint64_t> denseBytes(const Dims& dims, int channels, SampleType type);

/// The values of voxels [begin, begin + size), x slowest, z fastest, channels innermost: as in a
/// leaf of a VDB.
void readBlock(const DenseVolume& volume, const Dims& begin, const Dims& size, float* values);
void readBlock(const DenseVolume& volume, const Dims& begin, const Dims& size, double* values);

/// Gives the sides of voxels these lengths (world units). Directions and the first voxel's position
/// stay.
void setVoxelSides(DenseVolume& volume, Vec3d sides);

/// Places the volume so that its cells fill the cube from 0 to 1.
void fillUnitCube(DenseVolume& volume);

/// The same volume with one channel. Errors: Usage where there is no such channel.
DenseVolume selectChannel(DenseVolume volume, int channel);

/// Which axis of the source becomes x, y and z, and whether it is reversed.
struct AxisOrder {
    std::array<int, 3> from{0, 1, 2};
    std::array<bool, 3> reversed{};

    bool identity() const { return *this == AxisOrder{}; }
    Affine3d map() const;  ///< of world space
    bool operator==(const AxisOrder&) const = default;
};

/// "xzy", "x,-z,y" or "x-zy". Errors: Usage.
AxisOrder parseAxisOrder(std::string_view text);

/// Rotates or mirrors the volume in the world: for files with another axis up.
void applyAxisOrder(DenseVolume& volume, const AxisOrder& axes);

/// Permutes and reverses the index axes where that makes the transform a positive scale and a
/// translation, which all programs understand. Nothing moves in the world.
void straighten(DenseVolume& volume);

}  // namespace woodcock::convert
