// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/field.h"

#include <Imath/half.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <unordered_set>

#include "woodcock/base/error.h"

namespace woodcock {

namespace {

constexpr float largestHalf = 65504.0f;

Range rangeOf(std::span<const float> values) {
    Range r{values[0], values[0]};
    for (float v : values) r.add({v, v});
    return r;
}

/// The same for a whole brick, in lanes that a compiler can keep in one register.
Range rangeOfBrick(std::span<const float> values) {
    std::array<Range, 8> lanes;
    lanes.fill({values[0], values[0]});
    for (std::size_t i = 0; i < values.size(); i += 8)
        for (std::size_t j = 0; j < 8; ++j) lanes[j].add({values[i + j], values[i + j]});
    for (const Range& r : lanes) lanes[0].add(r);
    return lanes[0];
}

}  // namespace

class FieldBuilder {
public:
    FieldBuilder(const FieldSource& source, Storage storage) : source_(source) {
        field_.channels_ = source.channels;
        field_.background_ = source.background;
        copyBricks(storage);
        placeBlocks();
        findRanges();
    }
    Field take() { return std::move(field_); }

private:
    std::size_t brickValues() const { return 512 * field_.channelCount(); }

    std::uint32_t addConstant(const std::array<float, 3>& value) {
        const auto index =
            static_cast<std::uint32_t>(field_.constants_.size() / field_.channelCount());
        field_.constants_.insert(field_.constants_.end(), value.begin(),
                                 value.begin() + source_.channels);
        return Field::constantBit | index;
    }

    void copyBricks(Storage storage) {
        const std::size_t n = source_.leafOrigins.size();
        field_.brickCount_ = n;
        brickRanges_.resize(n);
        if (storage == Storage::Half) {
            copyAsHalf();
            return;
        }
        field_.floats_.resize(n * brickValues());
        std::atomic<bool> exactAsHalf{storage == Storage::Auto};
        tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
            const std::span<float> brick(field_.floats_.data() + i * brickValues(), brickValues());
            source_.copyLeaf(i, brick);
            brickRanges_[i] = rangeOfBrick(brick);
            if (!exactAsHalf.load(std::memory_order_relaxed)) return;
            for (float v : brick)
                if (!(std::abs(v) <= largestHalf) || static_cast<float>(Imath::half(v)) != v)
                    exactAsHalf.store(false, std::memory_order_relaxed);
        });
        if (!exactAsHalf) return;
        field_.half_ = true;
        field_.halves_.resize(field_.floats_.size());
        tbb::parallel_for(std::size_t{0}, field_.floats_.size() / 512, [&](std::size_t i) {
            for (std::size_t j = i * 512; j < (i + 1) * 512; ++j)
                field_.halves_[j] = Imath::half(field_.floats_[j]).bits();
        });
        field_.floats_ = std::vector<float>();  // frees them, as `= {}` would not
    }

    void copyAsHalf() {
        const std::size_t n = source_.leafOrigins.size();
        field_.half_ = true;
        field_.halves_.resize(n * brickValues());
        std::atomic<bool> overflow{false};
        tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
            std::array<float, 3 * 512> values;
            source_.copyLeaf(i, {values.data(), brickValues()});
            const Range exact = rangeOfBrick({values.data(), brickValues()});
            brickRanges_[i] = {Imath::half(exact.min), Imath::half(exact.max)};  // rounds in order
            for (std::size_t j = 0; j < brickValues(); ++j) {
                if (!(std::abs(values[j]) <= largestHalf)) overflow = true;
                field_.halves_[i * brickValues() + j] = Imath::half(values[j]).bits();
            }
        });
        if (overflow)
            throw inputError("a voxel exceeds {}, the largest half; use float storage",
                             largestHalf);
    }

    void placeBlocks() {
        Box3i bounds{{INT32_MAX, INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN, INT32_MIN}};
        const auto cover = [&](Vec3i origin, int size) {
            const Vec3i b{origin.x >> 3, origin.y >> 3, origin.z >> 3};
            const int n = size / 8 - 1;
            bounds.lower = min(bounds.lower, b - Vec3i{1, 1, 1});  // the ramp below the first voxel
            bounds.upper = max(bounds.upper, b + Vec3i{n, n, n});
        };
        for (Vec3i o : source_.leafOrigins) cover(o, 8);
        for (const FieldTile& t : source_.tiles) cover(t.origin, t.size);

        Field::Block outside;
        outside.ref = addConstant(source_.background);
        outside.range = rangeOf({source_.background.data(), field_.channelCount()});
        if (bounds.empty()) {
            field_.table_ = BlockTable<Field::Block>({}, outside, false);
            return;
        }
        const double volume = (1.0 + bounds.upper.x - bounds.lower.x) *
                              (1.0 + bounds.upper.y - bounds.lower.y) *
                              (1.0 + bounds.upper.z - bounds.lower.z);
        const bool dense =
            volume * sizeof(Field::Block) <= std::max(262144.0, static_cast<double>(sparseBytes()));
        field_.table_ = BlockTable<Field::Block>(bounds, outside, dense);

        for (const FieldTile& t : source_.tiles) {
            Field::Block block;
            block.ref = addConstant(t.value);
            block.range = rangeOf({t.value.data(), field_.channelCount()});
            field_.table_.fill({t.origin.x >> 3, t.origin.y >> 3, t.origin.z >> 3},
                               std::countr_zero(static_cast<unsigned>(t.size)), block);
        }
        for (std::size_t i = 0; i < source_.leafOrigins.size(); ++i) {
            const Vec3i o = source_.leafOrigins[i];
            field_.table_.at({o.x >> 3, o.y >> 3, o.z >> 3}).ref = static_cast<std::uint32_t>(i);
        }
    }

    /// What a sparse table of the leaves would take: 4096 blocks for each region that leaves touch.
    std::size_t sparseBytes() const {
        std::unordered_set<std::uint64_t> regions;
        std::uint64_t last = ~std::uint64_t{0};
        for (const Vec3i o : source_.leafOrigins)
            for (int i = 0; i < 8; ++i) {
                // The ramp below a leaf reaches into the next region only from a region's first
                // leaf.
                const Vec3i below{i & 1, i >> 1 & 1, i >> 2};
                if ((below.x && o.x & 127) || (below.y && o.y & 127) || (below.z && o.z & 127))
                    continue;
                const auto part = [](int v) {
                    return static_cast<std::uint64_t>(v >> regionLog2) & 0x1fffffu;
                };
                const Vec3i v = o - below;
                const std::uint64_t region = part(v.x) | part(v.y) << 21 | part(v.z) << 42;
                if (region != last) regions.insert(region);
                last = region;
            }
        return regions.size() * 4096 * sizeof(Field::Block);
    }

    /// Widens every block's range from its own voxels to all that interpolation inside it touches:
    /// the closed cube [8b, 8b+8] reads one layer of the neighbours on the + side.
    void findRanges() {
        if (!field_.table_.dense()) splitMixedRegions();
        field_.table_.shrink();
        std::vector<Vec3i> blocks;
        field_.table_.forEach([&](Vec3i b, int log2Size, Field::Block&) {
            if (log2Size == blockLog2) blocks.push_back(b);
        });
        std::vector<Range> ranges(blocks.size());
        tbb::parallel_for(std::size_t{0}, blocks.size(),
                          [&](std::size_t i) { ranges[i] = reconstructionRange(blocks[i]); });
        for (std::size_t i = 0; i < blocks.size(); ++i)
            field_.table_.at(blocks[i]).range = ranges[i];

        field_.range_ = field_.table_.outside().range;
        field_.table_.forEach([&](Vec3i, int, Field::Block& b) { field_.range_.add(b.range); });
        findSupport();
    }

    /// A sparse table shares one entry in a region that is all background or all tile. Where such a
    /// region looks onto other values across its + faces it is split into blocks; beyond a budget
    /// of memory its one entry takes the hull instead (looser there, never wrong).
    void splitMixedRegions() {
        std::unordered_set<std::uint64_t> seen;
        std::vector<Vec3i> regions;  // in blocks, multiples of 16
        const auto touch = [&](Vec3i block) {
            const Vec3i r{block.x & ~15, block.y & ~15, block.z & ~15};
            const auto part = [](int v) { return static_cast<std::uint64_t>(v >> 4) & 0x1fffffu; };
            if (seen.insert(part(r.x) | part(r.y) << 21 | part(r.z) << 42).second)
                regions.push_back(r);
        };
        const std::uint32_t outside = field_.table_.outside().ref;
        field_.table_.forEach([&](Vec3i b, int log2Size, Field::Block& block) {
            if (block.ref == outside) return;
            const int n = 1 << (log2Size - blockLog2);
            const int step = std::min(n, 16);
            for (int x = -1; x < n; x += x < 0 ? 1 : step)
                for (int y = -1; y < n; y += y < 0 ? 1 : step)
                    for (int z = -1; z < n; z += z < 0 ? 1 : step) touch(b + Vec3i{x, y, z});
        });
        std::sort(regions.begin(), regions.end(), [](Vec3i a, Vec3i b) {
            return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
        });
        std::size_t budget = (std::size_t{1} << 20) + field_.brickCount_ * brickValues() / 2;
        for (Vec3i r : regions) {
            const auto found = field_.table_.find(r);
            if (found.log2Size == blockLog2) continue;
            Field::Block uniform = *found.value;
            const Range hull = hullAcrossFaces(r, uniform.range);
            if (hull == uniform.range) continue;
            constexpr std::size_t cost = 4096 * sizeof(Field::Block);
            if (budget >= cost) {
                budget -= cost;
                field_.table_.at(r) = uniform;
            } else {
                uniform.range = hull;
                field_.table_.fill(r, regionLog2, uniform);
            }
        }
    }
    /// Region by region where a neighbour is uniform too, block by block along the face where not.
    Range hullAcrossFaces(Vec3i region, Range range) const {
        for (int i = 1; i < 8; ++i) {
            const Vec3i side{i & 1, i >> 1 & 1, i >> 2};
            const Vec3i corner = region + side * 16;
            const bool uniform = field_.table_.find(corner).log2Size > blockLog2;
            const Vec3i n =
                uniform ? Vec3i{1, 1, 1} : Vec3i{side.x ? 1 : 16, side.y ? 1 : 16, side.z ? 1 : 16};
            for (int x = 0; x < n.x; ++x)
                for (int y = 0; y < n.y; ++y)
                    for (int z = 0; z < n.z; ++z)
                        range.add(ownRange(field_.table_.find(corner + Vec3i{x, y, z}).value->ref,
                                           {side.x ? 1 : 8, side.y ? 1 : 8, side.z ? 1 : 8}));
        }
        return range;
    }

    Range reconstructionRange(Vec3i block) const {
        Range r = ownRange(field_.table_.find(block).value->ref, {8, 8, 8});
        for (int i = 1; i < 8; ++i) {
            const Vec3i side{i & 1, i >> 1 & 1, i >> 2};
            const std::uint32_t ref = field_.table_.find(block + side).value->ref;
            const Range whole = ownRange(ref, {8, 8, 8});
            if (whole.min >= r.min && whole.max <= r.max) continue;  // then so is its layer
            r.add(ownRange(ref, {side.x ? 1 : 8, side.y ? 1 : 8, side.z ? 1 : 8}));
        }
        return r;
    }
    /// Over the first `n` voxels along each axis of what `ref` names.
    Range ownRange(std::uint32_t ref, Vec3i n) const {
        const std::size_t channels = field_.channelCount();
        if (ref & Field::constantBit)
            return rangeOf({&field_.constants_[(ref & ~Field::constantBit) * channels], channels});
        if (n == Vec3i{8, 8, 8}) return brickRanges_[ref];
        const std::size_t base = std::size_t{ref} * 512;
        Range r{field_.stored(base * channels), field_.stored(base * channels)};
        for (int x = 0; x < n.x; ++x)
            for (int y = 0; y < n.y; ++y)
                for (int z = 0; z < n.z; ++z)
                    for (std::size_t c = 0; c < channels; ++c) {
                        const float v =
                            field_.stored((base + Field::offset({x, y, z})) * channels + c);
                        r.add({v, v});
                    }
        return r;
    }

    /// Trims to the voxels that differ from the background: rays start and end where the medium
    /// does.
    void findSupport() {
        const std::uint32_t outside = field_.table_.outside().ref;
        Box3d blocks, box;
        field_.table_.forEach([&](Vec3i b, int log2Size, Field::Block& block) {
            if (block.ref != outside) addCube(blocks, b * 8, 1 << log2Size);
        });
        const auto cover = [&](Vec3i v, int size, const Field::Block& block) {
            if (block.ref & Field::constantBit) {
                if (differsFromBackground(v)) addCube(box, v, size);
                return;
            }
            if (box.contains(v.as<double>()) && box.contains((v + Vec3i{7, 7, 7}).as<double>()))
                return;
            for (int i = 0; i < 512; ++i) {
                const Vec3i p = v + Vec3i{i >> 6, i >> 3 & 7, i & 7};
                if (differsFromBackground(p)) addCube(box, p, 1);
            }
        };
        // The outermost blocks first: few others then have voxels outside the box.
        for (const bool outermost : {true, false})
            field_.table_.forEach([&](Vec3i b, int log2Size, Field::Block& block) {
                const int size = 1 << log2Size;
                const Vec3d low = (b * 8).as<double>(), high = low + Vec3d{1, 1, 1} * (size - 1.0);
                bool atEdge = false;
                for (int i = 0; i < 3; ++i)
                    atEdge |= low[i] == blocks.lower[i] || high[i] == blocks.upper[i];
                if (block.ref != outside && atEdge == outermost) cover(b * 8, size, block);
            });
        if (!box.empty())
            field_.support_ = {box.lower - Vec3d{1, 1, 1}, box.upper + Vec3d{1, 1, 1}};
    }
    static void addCube(Box3d& box, Vec3i lowest, int size) {
        box.add(lowest.as<double>());
        box.add(lowest.as<double>() + Vec3d{1, 1, 1} * (size - 1.0));
    }
    bool differsFromBackground(Vec3i v) const {
        for (int c = 0; c < field_.channels_; ++c)
            if (field_.voxel(v, c) != field_.background(c)) return true;
        return false;
    }

    const FieldSource& source_;
    Field field_;
    std::vector<Range> brickRanges_;  // of each brick's own voxels
};

Field buildField(const FieldSource& source, Storage storage) {
    return FieldBuilder(source, storage).take();
}

std::size_t Field::bytes() const {
    return sizeof(*this) - sizeof(table_) + table_.bytes() + constants_.capacity() * sizeof(float) +
           floats_.capacity() * sizeof(float) + halves_.capacity() * sizeof(std::uint16_t);
}

}  // namespace woodcock
