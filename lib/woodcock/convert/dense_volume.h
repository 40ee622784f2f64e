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

namespace woodcock {

using Dims = std::array<std::int64_t, 3>;

/// Numbers on a regular lattice, as they lie in a file: bytes in memory, and where the one of voxel
/// (i, j, k) and channel c is among them. So the order of axes, the byte order and the type cost no
/// copy; a number is converted when it is asked for.
///
/// A value belongs to a point, not to a cell: that of voxel (i, j, k) to worldFromIndex.point(i, j,
/// k), which is where a VDB has it too. Formats that speak of cells in a box mean the cells'
/// centres.
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
    /// The channels are volumes of their own, one after the other ("times"), and no colour; empty:
    /// they belong together.
    std::string list;
    std::vector<std::string> notes;  ///< what a user should know about the reading

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

/// Bytes of dims x channels samples; nothing where they are not positive, too many along an axis,
/// or beyond 64 bits.
std::optional<std::uint64_t> denseBytes(const Dims& dims, int channels, SampleType type);

/// The values of voxels [begin, begin + size), x slowest, z fastest, channels innermost: as in a
/// leaf of a VDB.
void readBlock(const DenseVolume& volume, const Dims& begin, const Dims& size, float* values);
void readBlock(const DenseVolume& volume, const Dims& begin, const Dims& size, double* values);

/// Gives the sides of voxels these lengths; directions and the first voxel's place stay.
void setVoxelSides(DenseVolume& volume, Vec3d sides);

/// Cells that fill the cube from 0 to 1.
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

/// Turns the volume in the world as a rigid body: for files whose up is another axis.
void applyAxisOrder(DenseVolume& volume, const AxisOrder& axes);

/// Renames and reverses the axes of the index where that makes the transform a positive scale and a
/// translation, which all programs understand; nothing moves in the world.
void straighten(DenseVolume& volume);

}  // namespace woodcock
