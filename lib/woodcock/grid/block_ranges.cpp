// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/block_ranges.h"

#include <tbb/parallel_for.h>

#include <unordered_set>

namespace woodcock {

namespace {

/// How much of a neighbour's block interpolation reads, where it lies on the + side along `side`.
Vec3i layer(Vec3i side) { return {side.x ? 1 : 8, side.y ? 1 : 8, side.z ? 1 : 8}; }

Vec3i sideOf(int i) { return {i & 1, i >> 1 & 1, i >> 2}; }  // 1 to 7

class RangeFinder {
public:
    explicit RangeFinder(const Field& field) : field_(field) {
        Box3i bounds = field.blocks().bounds();
        bounds.lower = bounds.lower - Vec3i{1, 1, 1};  // the ramp below the first voxels
        const Range outside = field.storedRange(field.blocks().outside());
        ranges_ = BlockTable<Range>(bounds, outside, field.blocks().dense());
        if (!ranges_.dense()) placeRegions();
        const std::vector<Box3i> boxes = ranges_.boxes();
        tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t i) { fill(boxes[i]); });
    }
    BlockTable<Range> take() { return std::move(ranges_); }

private:
    void fill(const Box3i& box) {
        for (int z = box.lower.z; z <= box.upper.z; ++z)
            for (int y = box.lower.y; y <= box.upper.y; ++y)
                for (int x = box.lower.x; x <= box.upper.x; ++x)
                    ranges_.at({x, y, z}) = blockRange(field_, {x, y, z});
    }

    /// Makes entries for the blocks of a sparse table: for all of a region where the field has
    /// some, or where a constant region looks onto other values across its + faces.
    void placeRegions() {
        constexpr std::size_t cost = 4096 * 12;  // bytes of a region's blocks in a majorant grid
        std::size_t budget =
            (std::size_t{1} << 20) +
            field_.brickCount() * 256 * static_cast<std::size_t>(field_.channels());
        field_.blocks().forEach([&](Vec3i b, int log2Size, std::uint32_t ref) {
            if (log2Size > blockLog2) ranges_.fill(b, log2Size, field_.storedRange(ref));
        });
        for (Vec3i r : regionsThatMayDiffer()) {
            const auto found = field_.blocks().find(r);
            const Range own = field_.storedRange(*found.value);
            if (found.log2Size == blockLog2) {
                ranges_.at(r) = own;
                continue;
            }
            const Range hull = hullAcrossFaces(r, own);
            if (hull == own) continue;
            if (budget >= cost) {
                budget -= cost;
                ranges_.at(r) = own;
            } else {
                ranges_.fill(r, regionLog2, hull);
            }
        }
        ranges_.shrink();
    }

    /// Regions that hold anything but the background, and those on the - side of one; by their
    /// first block, in an order of their own.
    std::vector<Vec3i> regionsThatMayDiffer() const {
        std::unordered_set<std::uint64_t> seen;
        std::vector<Vec3i> regions;
        const auto touch = [&](Vec3i block) {
            const Vec3i r{block.x & ~15, block.y & ~15, block.z & ~15};
            const auto part = [](int v) { return static_cast<std::uint64_t>(v >> 4) & 0x1fffffu; };
            if (seen.insert(part(r.x) | part(r.y) << 21 | part(r.z) << 42).second)
                regions.push_back(r);
        };
        const std::uint32_t outside = field_.blocks().outside();
        field_.blocks().forEach([&](Vec3i b, int log2Size, std::uint32_t ref) {
            if (ref == outside) return;
            const int n = 1 << (log2Size - blockLog2);
            const int step = std::min(n, 16);
            for (int x = -1; x < n; x += x < 0 ? 1 : step)
                for (int y = -1; y < n; y += y < 0 ? 1 : step)
                    for (int z = -1; z < n; z += z < 0 ? 1 : step) touch(b + Vec3i{x, y, z});
        });
        std::sort(regions.begin(), regions.end(), [](Vec3i a, Vec3i b) {
            return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
        });
        return regions;
    }

    /// Region by region where a neighbour is constant too, block by block along the face where not.
    Range hullAcrossFaces(Vec3i region, Range range) const {
        for (int i = 1; i < 8; ++i) {
            const Vec3i side = sideOf(i);
            const Vec3i corner = region + side * 16;
            const bool constant = field_.blocks().find(corner).log2Size > blockLog2;
            const Vec3i n = constant ? Vec3i{1, 1, 1}
                                     : Vec3i{side.x ? 1 : 16, side.y ? 1 : 16, side.z ? 1 : 16};
            for (int x = 0; x < n.x; ++x)
                for (int y = 0; y < n.y; ++y)
                    for (int z = 0; z < n.z; ++z)
                        range.add(field_.storedRange(
                            *field_.blocks().find(corner + Vec3i{x, y, z}).value, layer(side)));
        }
        return range;
    }

    const Field& field_;
    BlockTable<Range> ranges_;
};

}  // namespace

Range blockRange(const Field& field, Vec3i block) {
    const std::uint32_t own = *field.blocks().find(block).value;
    Range r = field.storedRange(own);
    for (int i = 1; i < 8; ++i) {
        const std::uint32_t ref = *field.blocks().find(block + sideOf(i)).value;
        if (ref == own) continue;  // one constant
        const Range whole = field.storedRange(ref);
        if (whole.min >= r.min && whole.max <= r.max) continue;  // then so is its layer
        r.add(field.storedRange(ref, layer(sideOf(i))));
    }
    return r;
}

BlockTable<Range> blockRanges(const Field& field) { return RangeFinder(field).take(); }

}  // namespace woodcock
