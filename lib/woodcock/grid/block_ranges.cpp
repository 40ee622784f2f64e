// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/block_ranges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <unordered_set>
#include <vector>

namespace woodcock::grid {

namespace {

/// The part of a neighbouring block, on the + side along `side`, that interpolation reads.
Vec3i layer(Vec3i side) { return {side.x ? 1 : 8, side.y ? 1 : 8, side.z ? 1 : 8}; }

constexpr int regionSize = 1 << (regionLog2 - blockLog2),
              superSize = 1 << (superLog2 - blockLog2);  // blocks along an edge

/// Aligned cubes of `size` blocks.
class Seen {
public:
    explicit Seen(int size) : size_(size) {}
    /// True where the cube that holds this block is new.
    bool insert(Vec3i block) {
        const std::uint64_t key = keyOf(block);
        if (key == last_) return false;
        last_ = key;
        return cubes_.insert(key).second;
    }
    bool contains(Vec3i block) const { return cubes_.contains(keyOf(block)); }
    Vec3i first(Vec3i block) const {
        return {block.x & -size_, block.y & -size_, block.z & -size_};
    }

private:
    std::uint64_t keyOf(Vec3i block) const {
        const int shift = std::countr_zero(static_cast<unsigned>(size_));
        const auto part = [&](int v) { return static_cast<std::uint64_t>(v >> shift) & 0x1fffffu; };
        return part(block.x) | part(block.y) << 21 | part(block.z) << 42;
    }
    int size_;
    std::uint64_t last_ = ~std::uint64_t{0};  // neighbours come one after another
    std::unordered_set<std::uint64_t> cubes_;
};

void sortByPlace(std::vector<Vec3i>& cubes) {
    std::sort(cubes.begin(), cubes.end(), [](Vec3i a, Vec3i b) {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    });
}

class RangeFinder {
public:
    explicit RangeFinder(const Field& field) : field_(field) {
        Box3i bounds = field.blocks().bounds();
        bounds.lower =
            bounds.lower - Vec3i{1, 1, 1};  // interpolation begins a voxel below the first ones
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

    /// Makes entries for the blocks of a sparse table: for a whole region where the field has
    /// blocks, or where a constant region borders on other values across its + faces.
    void placeRegions() {
        constexpr std::size_t cost = 4096 * 12;  // bytes of a region's blocks in a majorant grid
        std::size_t budget =
            (std::size_t{1} << 20) +
            field_.brickCount() * 256 * static_cast<std::size_t>(field_.channels());
        field_.blocks().forEach([&](Vec3i b, int log2Size, std::uint32_t ref) {
            if (log2Size > blockLog2) ranges_.fill(b, log2Size, field_.storedRange(ref));
        });
        placeSupers();
        for (Vec3i r : regionsThatMayDiffer()) {
            const auto found = field_.blocks().find(r);
            const Range own = field_.storedRange(*found.value);
            if (found.log2Size == blockLog2) {
                ranges_.at(r) = own;
                continue;
            }
            const Range hull = hullAcrossFaces(r, regionSize, own);
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

    /// Decides which constant super-regions are handled region by region. Each takes some 300 kB,
    /// for which a file needs only the 17 bytes of a tile, so their number is limited. The others
    /// take the range of everything that they border on.
    void placeSupers() {
        std::vector<Vec3i> supers;
        Seen seen(superSize);
        std::size_t budget = 64;
        const std::uint32_t outside = field_.blocks().outside();
        const auto touch = [&](Vec3i block) {
            if (seen.insert(block)) supers.push_back(seen.first(block));
        };
        Seen split(superSize);
        field_.blocks().forEach([&](Vec3i b, int log2Size, std::uint32_t ref) {
            if (log2Size < superLog2 && split.insert(b)) budget += 8;
            if (ref == outside) return;
            const auto atFace = [](int v, int side) {
                return side == 0 || (v & (superSize - 1)) == 0;
            };
            for (int i = 0; i < 8; ++i) {
                const Vec3i side = sideOf(i);
                if (atFace(b.x, side.x) && atFace(b.y, side.y) && atFace(b.z, side.z))
                    touch(b - side);
            }
        });
        sortByPlace(supers);
        for (Vec3i s : supers) {
            const auto found = field_.blocks().find(s);
            if (found.log2Size < superLog2) continue;
            const Range own = field_.storedRange(*found.value);
            const Range hull = hullAcrossFaces(s, superSize, own);
            if (hull == own) continue;
            if (budget > 0) {
                --budget;
                byRegions_.insert(s);
            } else {
                ranges_.fill(s, superLog2, hull);
            }
        }
    }

    /// Regions that hold other values than the background, and the regions on the - side of one, by
    /// their first block. Of a constant super-region those at its + faces, where placeSupers()
    /// decided so.
    std::vector<Vec3i> regionsThatMayDiffer() const {
        Seen seen(regionSize);
        std::vector<Vec3i> regions;
        const auto touch = [&](Vec3i block) {
            const bool constant = field_.blocks().find(block).log2Size == superLog2;
            if (constant && !byRegions_.contains(block)) return;
            if (seen.insert(block)) regions.push_back(seen.first(block));
        };
        const std::uint32_t outside = field_.blocks().outside();
        field_.blocks().forEach([&](Vec3i b, int log2Size, std::uint32_t ref) {
            if (ref == outside) return;
            const int n = 1 << (log2Size - blockLog2);
            const int step = std::min(n, regionSize), last = n - step;
            const auto atFace = [&](int v) { return v < 0 || v == last; };
            for (int x = -1; x < n; x += x < 0 ? 1 : step)
                for (int y = -1; y < n; y += y < 0 ? 1 : step)
                    for (int z = -1; z < n; z += z < 0 ? 1 : step)
                        if (atFace(x) || atFace(y) || atFace(z)) touch(b + Vec3i{x, y, z});
        });
        sortByPlace(regions);
        return regions;
    }

    /// The range of a constant cube of `size` blocks and what lies across its + faces: region by
    /// region where a neighbour is constant too, else block by block along the face.
    Range hullAcrossFaces(Vec3i cube, int size, Range range) const {
        for (int i = 1; i < 8; ++i) {
            const Vec3i side = sideOf(i);
            const Vec3i corner = cube + side * size;
            const Vec3i n{side.x ? 1 : size, side.y ? 1 : size, side.z ? 1 : size};
            addFace(corner, n, side, range);
        }
        return range;
    }
    /// The layer of voxels next to the cube, of n blocks from `corner` on.
    void addFace(Vec3i corner, Vec3i n, Vec3i side, Range& range) const {
        const auto found = field_.blocks().find(corner);
        const int across = std::max({n.x, n.y, n.z});
        if (across <= 1 << (found.log2Size - blockLog2)) {
            const Vec3i voxels = found.log2Size > blockLog2 ? Vec3i{1, 1, 1} : layer(side);
            range.add(field_.storedRange(*found.value, voxels));
            return;
        }
        const int step = across > regionSize ? regionSize : 1;
        const auto part = [&](int whole) { return std::min(whole, step); };
        for (int x = 0; x < n.x; x += step)
            for (int y = 0; y < n.y; y += step)
                for (int z = 0; z < n.z; z += step)
                    addFace(corner + Vec3i{x, y, z}, {part(n.x), part(n.y), part(n.z)}, side,
                            range);
    }

    const Field& field_;
    BlockTable<Range> ranges_;
    Seen byRegions_{superSize};  // constant super-regions that are looked at region by region
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

}  // namespace woodcock::grid
