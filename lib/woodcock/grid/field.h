// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/grid/block_table.h"
#include "woodcock/grid/field_source.h"
#include "woodcock/grid/half.h"

namespace woodcock::grid {

/// The smallest and the largest of some values.
struct Range {
    float min = 0, max = 0;
    void add(Range r) { min = std::min(min, r.min), max = std::max(max, r.max); }
    bool operator==(const Range&) const = default;
};

/// The values that the voxels of one brick can have in fixed storage: low + step x code, for codes
/// from 0 to `last`.
struct FixedScale {
    float low = 0, step = 0;

    /// For values from `min` to `max`, range = max - min.
    /// Where their signs agree, `min` is one of the values and none is above `max`. The error is
    /// at most half of range / last, up to the rounding of floats.
    /// Where their signs differ, zero is one of the values. The error is at most half of
    /// 1.01 range / (last - 1), and values may lie outside by as much.
    /// Below 1e-38 floats are too coarse for these bounds.
    /// Throws Error{Input} where signs differ and `last` steps are more than a float holds.
    static FixedScale of(float min, float max, unsigned last);

    float value(unsigned code) const { return low + step * static_cast<float>(code); }
    /// The code of the value nearest to `v`.
    unsigned code(float v, unsigned last) const;
};

/// A sparse grid that is fast to read: 8x8x8 bricks in flat memory, found in O(1). Values lie at
/// integer index positions. They are interpolated trilinearly, or the nearest one is taken where
/// setLookup() says so. Outside is the background. It does not depend on sigma.
class Field {
public:
    int channels() const { return channels_; }
    Storage storage() const { return storage_; }
    /// In fixed storage: the largest difference between a voxel and its source. Otherwise 0.
    float largestFixedError() const { return largestFixedError_; }
    float background(int channel = 0) const { return background_[static_cast<size_t>(channel)]; }

    /// Index-space box outside which the reconstruction is the background: one voxel around all
    /// voxels of a leaf or tile that differ from it. Empty when there are none.
    const Box3d& support() const { return support_; }

    /// Index-space box outside of which a medium made of the field is 0, although the field itself
    /// says background there; absent: it is the background everywhere.
    const std::optional<Box3d>& limits() const { return limits_; }

    /// Index-space box of a medium made of the field, but for a background without limits.
    const Box3d& extent() const { return limits_ ? *limits_ : support_; }

    /// The point of the support next to `p`, or `p` inside it: the reconstruction there is the
    /// same, and voxel numbers fit an int.
    Vec3d nearSupport(Vec3d p) const {
        return support_.empty() ? Vec3d{} : max(support_.lower, min(support_.upper, p));
    }

    /// Nearest is biased: every voxel fills the unit cube around its position, and trilinear() and
    /// stochastic() return the voxel that fills `p`. Ranges and support hold for both.
    Lookup lookup() const { return nearest_ ? Lookup::Nearest : Lookup::Trilinear; }
    void setLookup(Lookup lookup) {
        nearest_ = lookup == Lookup::Nearest;
        jitterUnit_ = nearest_ ? 0 : 0x1p-21, firstJitter_ = nearest_ ? 0.5 : 0x1p-22;
    }

    /// The stored value of voxel `v` (any index).
    float voxel(Vec3i v, int channel = 0) const {
        return valueOf(*table_.find({v.x >> 3, v.y >> 3, v.z >> 3}).value, v, channel);
    }

    /// Trilinear interpolation at index-space position `p`, at most 2^31 voxels away: of N channels
    /// from `channel` on.
    template <int N>
    std::array<float, N> interpolated(Vec3d p, int channel = 0) const {
        std::array<float, N> values;
        if (nearest_) {
            for (int c = 0; c < N; ++c)
                values[static_cast<std::size_t>(c)] = voxel(nearestVoxel(p), channel + c);
            return values;
        }
        const Vec3i v = floorToInt(p);
        const auto cell = cellVoxels<N>(v, channel);
        for (std::size_t c = 0; c < N; ++c) values[c] = interpolate(cell[c], p - v.as<double>());
        return values;
    }
    float trilinear(Vec3d p, int channel = 0) const { return interpolated<1>(p, channel)[0]; }

    /// One of the eight voxels around `p`, chosen with its trilinear weight. Its expectation is
    /// trilinear(p), at an eighth of the loads. Use it only where the value enters linearly. Pharr
    /// et al. 2024, "Filtering After Shading With Stochastic Texture Filtering".
    Vec3i stochasticVoxel(Vec3d p, std::uint64_t bits) const {
        const auto jitter = [&](std::uint64_t part) {  // in (0, 1)
            return static_cast<double>(part & 0x1fffff) * jitterUnit_ + firstJitter_;
        };
        return floorToInt(p + Vec3d{jitter(bits), jitter(bits >> 21), jitter(bits >> 42)});
    }
    /// The voxel nearest to `p`; of two, the upper one.
    static Vec3i nearestVoxel(Vec3d p) { return floorToInt(p + Vec3d{0.5, 0.5, 0.5}); }
    float stochastic(Vec3d p, std::uint64_t bits, int channel = 0) const {
        return voxel(stochasticVoxel(p, bits), channel);
    }

    /// The eight voxels of the lattice's cell from `v` to one voxel further along each axis: x
    /// first, then y. Of N channels from `channel` on.
    template <int N = 1>
    std::array<std::array<float, 8>, N> cellVoxels(Vec3i v, int channel = 0) const {
        std::array<std::array<float, 8>, N> values;
        constexpr int last = (1 << blockLog2) - 1;
        // Bits, as in the numbers of voxels: the axes along which the cell ends in another block.
        const unsigned into = unsigned{(v.x & last) == last} | unsigned{(v.y & last) == last} << 1 |
                              unsigned{(v.z & last) == last} << 2;
        std::array<std::uint32_t, 8> refs{};
        refs[0] = *table_.find({v.x >> 3, v.y >> 3, v.z >> 3}).value;
        if (!into && storage_ == Storage::Float && !(refs[0] & constantBit)) {
            const std::size_t channels = channelCount();
            const float* first = &floats_[(std::size_t{refs[0]} * 512 + offset(v)) * channels +
                                          static_cast<std::size_t>(channel)];
            for (unsigned i = 0; i < 8; ++i)
                for (std::size_t c = 0; c < N; ++c)
                    values[c][i] =
                        first[((i & 1) * 64 + (i >> 1 & 1) * 8 + (i >> 2)) * channels + c];
            return values;
        }
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3i at = v + Vec3i{static_cast<int>(i & 1), static_cast<int>(i >> 1 & 1),
                                       static_cast<int>(i >> 2)};
            if (i > 0 && (i & into) == i)
                refs[i] = *table_.find({at.x >> 3, at.y >> 3, at.z >> 3}).value;
            for (int c = 0; c < N; ++c)
                values[static_cast<std::size_t>(c)][i] = valueOf(refs[i & into], at, channel + c);
        }
        return values;
    }

    /// Interpolates between the voxels of a cell; f: from the first of them, in [0, 1].
    static float interpolate(const std::array<float, 8>& v, Vec3d f) {
        const auto lerp = [](double t, double a, double b) { return a + t * (b - a); };
        const auto row = [&](std::size_t i) { return lerp(f.x, v[i], v[i + 1]); };
        return static_cast<float>(lerp(f.z, lerp(f.y, row(0), row(2)), lerp(f.y, row(4), row(6))));
    }

    /// The voxels of one block, found once for many reads.
    class BlockVoxels {
    public:
        BlockVoxels(const Field& field, Vec3i block)
            : field_(&field), ref_(*field.table_.find(block).value) {}
        /// The value of voxel `v` of the block (any index; its last three bits count).
        float operator()(Vec3i v, int channel = 0) const {
            return field_->valueOf(ref_, v, channel);
        }

    private:
        const Field* field_;
        std::uint32_t ref_;
    };

    /// The content of each block: the number of a brick or of a constant. Blocks of equal numbers
    /// have equal voxels.
    const BlockTable<std::uint32_t>& blocks() const { return table_; }
    /// The range of stored values, over all channels, of the brick or constant `ref`: of all its
    /// voxels, or of the first `n` along each axis.
    Range storedRange(std::uint32_t ref) const;
    Range storedRange(std::uint32_t ref, Vec3i n) const;

    /// The range over all of space.
    Range range() const { return range_; }
    std::size_t brickCount() const { return brickRanges_.size(); }
    std::size_t bytes() const;  ///< memory held, tables included

private:
    friend class FieldBuilder;
    static constexpr std::uint32_t constantBit = 0x80000000u;

    std::size_t channelCount() const { return static_cast<std::size_t>(channels_); }
    static std::size_t offset(Vec3i v) {
        return static_cast<std::size_t>((v.x & 7) << 6 | (v.y & 7) << 3 | (v.z & 7));
    }
    float valueOf(std::uint32_t ref, Vec3i v, int channel) const {
        const auto c = static_cast<std::size_t>(channel);
        if (ref & constantBit) return constants_[(ref & ~constantBit) * channelCount() + c];
        const std::size_t i = (std::size_t{ref} * 512 + offset(v)) * channelCount() + c;
        if (storage_ == Storage::Float) return floats_[i];
        if (storage_ == Storage::Half) return decodeHalf(words_[i]);
        return scales_[std::size_t{ref} * channelCount() + c].value(
            storage_ == Storage::Fixed16 ? words_[i] : bytes_[i]);
    }

    int channels_ = 1;
    Storage storage_ = Storage::Float;
    bool nearest_ = false;
    double jitterUnit_ = 0x1p-21, firstJitter_ = 0x1p-22;  // of stochasticVoxel()
    std::array<float, 3> background_{};
    Box3d support_;
    std::optional<Box3d> limits_;
    Range range_;
    BlockTable<std::uint32_t> table_;  // bricks, or constantBit | constant
    std::vector<float> constants_;
    std::vector<Range> brickRanges_;
    // 512 x channels values for each brick, in one of these. Vectors would first fill them with
    // zeros.
    std::unique_ptr<float[]> floats_;
    std::unique_ptr<std::uint16_t[]> words_;  // halves, or codes
    std::unique_ptr<std::uint8_t[]> bytes_;
    std::vector<FixedScale> scales_;  // of codes: one for each brick and channel
    float largestFixedError_ = 0;
};

/// Builds the field in parallel. Errors: Input when half storage is asked for values beyond 65504,
/// or fixed storage for those that FixedScale refuses.
Field buildField(const FieldSource& source, Storage storage);

}  // namespace woodcock::grid
