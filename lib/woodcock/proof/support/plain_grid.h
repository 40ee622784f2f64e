// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "woodcock/grid/field.h"
#include "woodcock/grid/field_source.h"

namespace woodcock::proof {

/// A grid as a plain list of leaves and tiles, looked up and interpolated in the most obvious way:
/// the truth that a Field, its majorants and the trackers are held against.
class PlainGrid {
public:
    explicit PlainGrid(int channels = 1, std::array<float, 3> background = {})
        : channels_(channels), background_(background) {}

    /// `value(voxel, channel)` over the 8x8x8 voxels from `origin`.
    void setLeaf(Vec3i origin, const std::function<float(Vec3i, int)>& value);
    void setTile(Vec3i origin, int size, std::array<float, 3> value);

    int channels() const { return channels_; }
    const std::vector<Vec3i>& leaves() const { return leafOrigins_; }
    const std::vector<grid::FieldTile>& tiles() const { return tiles_; }
    float background(int channel = 0) const { return background_[static_cast<size_t>(channel)]; }

    float voxel(Vec3i v, int channel = 0) const;
    double trilinear(Vec3d p, int channel = 0) const;
    /// Smallest and largest voxel of the box, both ends included, over all channels.
    grid::Range range(Vec3i lower, Vec3i upper) const;
    /// One voxel around all voxels of leaves and tiles that differ from the background.
    Box3d support() const;

    /// Refers to this grid.
    grid::FieldSource source() const;
    grid::Field field(grid::Storage storage = grid::Storage::Float) const {
        return grid::buildField(source(), storage);
    }

private:
    int channels_;
    std::array<float, 3> background_;
    std::vector<Vec3i> leafOrigins_;
    std::map<std::array<int, 3>, std::vector<float>> leaves_;
    std::vector<grid::FieldTile> tiles_;
};

/// A grid with a bit of everything near the origin: leaves of rough noise (a third of the voxels
/// zero), of a smooth ramp and of a constant, gaps, and a tile of 8 voxels; on both sides of zero.
/// Values lie in [0, 1] and survive half.
PlainGrid mixedGrid(std::uint64_t seed, int channels = 1, std::array<float, 3> background = {});

/// mixedGrid() with leaves and tiles of 128 and 4096 voxels scattered far around it: too wide for a
/// flat table.
PlainGrid scatteredGrid(std::uint64_t seed, int channels = 1, std::array<float, 3> background = {});

}  // namespace woodcock::proof
