// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "woodcock/grid/block_table.h"
#include "woodcock/grid/field.h"

namespace woodcock::grid {

/// Bounds of a field in cells of 2 to 4096 voxels: the majorants and minorants of null-collision
/// tracking. The cells form the octree of least cost for a random ray: a step into a cell costs as
/// much as `stepCost` collisions, and every unit of majorant optical depth costs one collision.
class MajorantGrid {
public:
    struct Options {
        /// Optical depth of one voxel's width where the field is 1 (largest channel).
        double depthPerVoxel = 1;
        /// Loosens the upper bound (>= 1): this costs time and changes no mean.
        double scale = 1;
        /// No cell below 2^smallestLog2 voxels: 1 (finest) to 7.
        int smallestLog2 = 1;
    };
    static constexpr double stepCost = 0.8;

    /// The aligned cube of 2^log2Size voxels around a voxel, with its bounds.
    struct Cell {
        Range range;
        int log2Size;
    };

    /// Bounds of the 64 cells of 2^3 voxels in a block, x first.
    using FinestRanges = std::function<std::array<Range, 64>(Vec3i block)>;

    MajorantGrid() = default;
    MajorantGrid(const Field& field, const Options& options);
    /// Of bounds that were found otherwise: of all blocks, and of the parts of one.
    MajorantGrid(const BlockTable<Range>& blocks, const FinestRanges& finest,
                 const Options& options);

    Cell find(Vec3i voxel) const {
        const auto found = table_.find({voxel.x >> 3, voxel.y >> 3, voxel.z >> 3});
        const Entry& e = *found.value;
        if (e.code >= 0) return {e.range, std::max(e.code, found.log2Size)};
        const auto part = static_cast<std::uint32_t>(~e.code);
        const int log2Size = part & 1 ? 1 : 2;  // 64 cells of 2^3 voxels or 8 of 4^3
        const int n = blockLog2 - log2Size, mask = (1 << n) - 1;
        const Part& p = parts_[(part >> 1) +
                               static_cast<std::uint32_t>((voxel.x >> log2Size & mask) |
                                                          (voxel.y >> log2Size & mask) << n |
                                                          (voxel.z >> log2Size & mask) << (2 * n))];
        return {{widen(p.min), widen(p.max)}, log2Size};
    }

    /// Calls f(first voxel, log2 of the size in voxels, bounds) for aligned cubes that hold all of
    /// space but where the field is the background: blocks, and larger ones of a sparse table.
    template <class F>
    void forEachEntry(F&& f) const {
        table_.forEach([&](Vec3i block, int log2Size, const Entry& e) {
            f(block * (1 << blockLog2), log2Size, e.range);
        });
    }
    std::size_t entries() const { return table_.bytes() / sizeof(Entry); }  ///< roughly

    /// The number of blocks in cells whose two bounds differ.
    double varyingBlocks() const;

    std::size_t bytes() const { return table_.bytes() + parts_.capacity() * sizeof(Part); }

private:
    /// code >= 0: log2 of the cell's size in voxels; else ~code is 2 x first part + (parts are
    /// 2^3).
    struct Entry {
        Range range;
        std::int32_t code = blockLog2;
        bool operator==(const Entry&) const = default;
    };
    /// Bounds inside a brick, as the upper halves of floats, rounded outwards.
    struct Part {
        std::uint16_t min, max;
    };
    static float widen(std::uint16_t upper) {
        return std::bit_cast<float>(std::uint32_t{upper} << 16);
    }

    /// Splits bricks whose bounds are loose enough to pay for it.
    void splitLooseBlocks(const FinestRanges& finest, const Options& options);
    /// Merges blocks into larger cells, region by region, where a step that is saved is worth the
    /// looser bounds.
    void mergeBlocks(const Options& options);

    BlockTable<Entry> table_;
    std::vector<Part> parts_;
};

/// How well a majorant grid fits its field.
struct MajorantStatistics {
    double segmentsPerRay = 0;    ///< mean over rays that meet the field
    double segmentsError = 0;     ///< its standard error
    double majorantOverMean = 0;  ///< mean upper bound over mean value, along those rays
    double majorantOverMeanError = 0;
    std::size_t rays = 0;
};

/// Measured along `rays` random chords through the support (isotropic, uniform over the bounding
/// sphere).
MajorantStatistics majorantStatistics(const Field& field, const MajorantGrid& majorants, int rays);

}  // namespace woodcock::grid
