// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "woodcock/base/huge_pages.h"
#include "woodcock/base/vec.h"

namespace woodcock::grid {

/// A block is 8x8x8 voxels. log2 of the voxels along an edge of: a block, a region of 16^3 blocks,
/// a super-region of 32^3 regions. (These are the nodes of OpenVDB's default tree, so its tiles
/// coincide with them.)
inline constexpr int blockLog2 = 3, regionLog2 = 7, superLog2 = 12;

/// Maps blocks to values in O(1). It is a flat array over the bounds where that is small. Otherwise
/// it is a hashed root of tables of regions, and these are tables of blocks; a whole region may
/// share one value.
template <class T>
class BlockTable {
public:
    /// A value and the cube of voxels, 2^log2Size wide and aligned to its size, that shares it.
    struct Found {
        const T* value;
        int log2Size;
    };

    BlockTable() = default;
    /// `bounds` in blocks, both ends included. `outside` is the value of every block that is not
    /// set.
    BlockTable(Box3i bounds, T outside, bool dense)
        : bounds_(bounds), outside_(outside), dense_(dense) {
        if (!dense_) return;
        for (int i = 0; i < 3; ++i) extent_[i] = bounds.upper[i] - bounds.lower[i] + 1;
        reserveLarge(blocks_, volume(bounds));
        blocks_.assign(volume(bounds), outside);
    }

    /// Bytes of a sparse table with so many regions and super-regions that are not uniform.
    static std::size_t sparseBytes(std::size_t regions, std::size_t supers) {
        return regions * regionBlocks * sizeof(T) + supers * superRegions * sizeof(std::uint32_t);
    }
    static std::size_t volume(Box3i b) {
        std::size_t n = 1;
        for (int i = 0; i < 3; ++i)
            n *= static_cast<std::size_t>(std::int64_t{b.upper[i]} - b.lower[i] + 1);
        return n;
    }

    Box3i bounds() const { return bounds_; }
    bool dense() const { return dense_; }
    const T& outside() const { return outside_; }

    Found find(Vec3i b) const {
        if (dense_) {
            const Vec3i o = b - bounds_.lower;
            if (static_cast<unsigned>(o.x) >= static_cast<unsigned>(extent_.x) ||
                static_cast<unsigned>(o.y) >= static_cast<unsigned>(extent_.y) ||
                static_cast<unsigned>(o.z) >= static_cast<unsigned>(extent_.z))
                return {&outside_, blockLog2};
            return {&blocks_[denseIndex(o)], blockLog2};
        }
        const auto super = supers_.find(superKey(b));
        if (super == supers_.end()) return {&outside_, superLog2};
        if (super->second & uniformBit) return {&uniform_[super->second & ~uniformBit], superLog2};
        const std::uint32_t region = regions_[super->second + regionIndex(b)];
        if (region & uniformBit) return {&uniform_[region & ~uniformBit], regionLog2};
        return {&blocks_[region + blockIndex(b)], blockLog2};
    }

    /// The value of one block, writable: splits uniform regions where needed.
    T& at(Vec3i b) {
        if (dense_) return blocks_[denseIndex(b - bounds_.lower)];
        auto [super, fresh] = supers_.try_emplace(superKey(b), 0u);
        if (fresh) super->second = newUniform(outside_);
        std::uint32_t& region = regions_[split(super->second, regions_, superRegions,
                                               [](std::uint32_t uniform) { return uniform; }) +
                                         regionIndex(b)];
        return blocks_[split(
                           region, blocks_, regionBlocks,
                           [&](std::uint32_t uniform) { return uniform_[uniform & ~uniformBit]; }) +
                       blockIndex(b)];
    }

    /// Sets an aligned cube of 2^log2Size voxels (a block, region or super-region).
    void fill(Vec3i origin, int log2Size, const T& value) {
        if (!dense_ && log2Size == superLog2) {
            supers_[superKey(origin)] = newUniform(value);
            return;
        }
        if (!dense_ && log2Size == regionLog2) {
            auto [super, fresh] = supers_.try_emplace(superKey(origin), 0u);
            if (fresh) super->second = newUniform(outside_);
            regions_[split(super->second, regions_, superRegions,
                           [](std::uint32_t uniform) { return uniform; }) +
                     regionIndex(origin)] = newUniform(value);
            return;
        }
        const int n = 1 << (log2Size - blockLog2);
        for (int x = 0; x < n; ++x)
            for (int y = 0; y < n; ++y)
                for (int z = 0; z < n; ++z) at(origin + Vec3i{x, y, z}) = value;
    }

    /// Calls f(firstBlock, log2Size, value) for every entry, in the same order on every machine.
    /// Leaves out entries of a sparse table that were never set.
    template <class F>
    void forEach(F&& f) const {
        if (dense_) {
            std::size_t i = 0;
            for (int z = bounds_.lower.z; z <= bounds_.upper.z; ++z)
                for (int y = bounds_.lower.y; y <= bounds_.upper.y; ++y)
                    for (int x = bounds_.lower.x; x <= bounds_.upper.x; ++x)
                        f(Vec3i{x, y, z}, blockLog2, blocks_[i++]);
            return;
        }
        for (std::uint64_t key : sortedSupers()) {
            const Vec3i s = superOrigin(key);
            const std::uint32_t super = supers_.at(key);
            if (super & uniformBit) {
                f(s, superLog2, uniform_[super & ~uniformBit]);
                continue;
            }
            for (int i = 0; i < 32768; ++i) {
                const Vec3i r = s + Vec3i{i & 31, (i >> 5) & 31, i >> 10} * 16;
                const std::uint32_t region = regions_[super + static_cast<std::uint32_t>(i)];
                if (region & uniformBit) {
                    f(r, regionLog2, uniform_[region & ~uniformBit]);
                    continue;
                }
                for (int j = 0; j < 4096; ++j)
                    f(r + Vec3i{j & 15, (j >> 4) & 15, j >> 8}, blockLog2,
                      blocks_[region + static_cast<std::uint32_t>(j)]);
            }
        }
    }

    /// Boxes that together hold all blocks with an entry of their own. at() may be called for
    /// blocks of different boxes at the same time.
    std::vector<Box3i> boxes() const {
        std::vector<Box3i> boxes;
        if (dense_) {
            for (int z = bounds_.lower.z; z <= bounds_.upper.z; ++z)
                boxes.push_back(
                    {{bounds_.lower.x, bounds_.lower.y, z}, {bounds_.upper.x, bounds_.upper.y, z}});
            return boxes;
        }
        for (std::uint64_t key : sortedSupers()) {
            const std::uint32_t super = supers_.at(key);
            if (super & uniformBit) continue;
            for (int i = 0; i < 32768; ++i) {
                if (regions_[super + static_cast<std::uint32_t>(i)] & uniformBit) continue;
                const Vec3i r = superOrigin(key) + Vec3i{i & 31, (i >> 5) & 31, i >> 10} * 16;
                boxes.push_back({r, r + Vec3i{15, 15, 15}});
            }
        }
        return boxes;
    }

    /// A table of the same shape, with each value mapped by f.
    template <class U, class F>
    BlockTable<U> map(F&& f) const {
        BlockTable<U> t;
        t.bounds_ = bounds_, t.extent_ = extent_, t.dense_ = dense_;
        t.outside_ = f(outside_);
        reserveLarge(t.blocks_, blocks_.size()), t.uniform_.reserve(uniform_.size());
        for (const T& v : blocks_) t.blocks_.push_back(f(v));
        for (const T& v : uniform_) t.uniform_.push_back(f(v));
        t.regions_ = regions_, t.supers_ = supers_;
        return t;
    }

    /// Makes room in a sparse table for this many regions and super-regions.
    void reserve(std::size_t regions, std::size_t supers) {
        reserveLarge(blocks_, regions * regionBlocks);
        reserveLarge(regions_, supers * superRegions);
    }
    /// Frees memory that only building needed.
    void shrink() { shrinkLarge(blocks_), uniform_.shrink_to_fit(), shrinkLarge(regions_); }

    std::size_t bytes() const {
        return sizeof(*this) + (blocks_.size() + uniform_.size()) * sizeof(T) +
               regions_.size() * sizeof(std::uint32_t) + supers_.size() * 32;
    }

private:
    template <class U>
    friend class BlockTable;

    static constexpr std::uint32_t uniformBit = 0x80000000u;
    static constexpr std::size_t regionBlocks = 4096, superRegions = 32768;

    std::size_t denseIndex(Vec3i o) const {
        return static_cast<std::size_t>(o.x) +
               static_cast<std::size_t>(extent_.x) *
                   (static_cast<std::size_t>(o.y) +
                    static_cast<std::size_t>(extent_.y) * static_cast<std::size_t>(o.z));
    }
    static std::uint64_t superKey(Vec3i b) {
        const auto part = [](int v) { return static_cast<std::uint64_t>((v >> 9) & 0x1fffff); };
        return part(b.x) | part(b.y) << 21 | part(b.z) << 42;
    }
    static Vec3i superOrigin(std::uint64_t key) {
        const auto part = [&](int shift) {  // sign-extended from 21 bits, then times 512 blocks
            return static_cast<int>(static_cast<std::int64_t>(key << (43 - shift)) >> 43) * 512;
        };
        return {part(0), part(21), part(42)};
    }
    static std::uint32_t regionIndex(Vec3i b) {
        return static_cast<std::uint32_t>(((b.x >> 4) & 31) | ((b.y >> 4) & 31) << 5 |
                                          ((b.z >> 4) & 31) << 10);
    }
    static std::uint32_t blockIndex(Vec3i b) {
        return static_cast<std::uint32_t>((b.x & 15) | (b.y & 15) << 4 | (b.z & 15) << 8);
    }
    /// Neighbours of equal value share one entry.
    std::uint32_t newUniform(const T& value) {
        if (uniform_.empty() || uniform_.back() != value) uniform_.push_back(value);
        return uniformBit | static_cast<std::uint32_t>(uniform_.size() - 1);
    }
    /// The table of `slot`, made from its uniform value if there is none yet.
    template <class V, class F>
    static std::uint32_t split(std::uint32_t& slot, std::vector<V>& pool, std::size_t size,
                               F&& childOf) {
        if (slot & uniformBit) {
            const V child = childOf(slot);
            slot = static_cast<std::uint32_t>(pool.size());
            pool.resize(pool.size() + size, child);
        }
        return slot;
    }
    std::vector<std::uint64_t> sortedSupers() const {
        std::vector<std::uint64_t> keys;
        for (const auto& [key, slot] : supers_) keys.push_back(key);
        std::sort(keys.begin(), keys.end());
        return keys;
    }

    Box3i bounds_;
    Vec3i extent_{};
    T outside_{};
    bool dense_ = true;
    std::vector<T> blocks_;               // dense: the whole array; sparse: tables of 4096
    std::vector<T> uniform_;              // values of whole regions and super-regions
    std::vector<std::uint32_t> regions_;  // tables of 32768: into blocks_, or uniformBit | uniform_
    std::unordered_map<std::uint64_t, std::uint32_t> supers_;
};

}  // namespace woodcock::grid
