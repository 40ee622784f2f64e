// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/field.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "woodcock/base/error.h"
#include "woodcock/base/huge_pages.h"

namespace woodcock::grid {

namespace {

Range rangeOf(std::span<const float> values) {
    Range r{values[0], values[0]};
    for (float v : values) r.add({v, v});
    return r;
}

/// The same for a whole brick, in so many lanes that the compiler makes vector code.
Range rangeOfBrick(std::span<const float> values) {
    constexpr std::size_t lanes = 64;
    std::array<float, lanes> low, high;
    low.fill(values[0]), high.fill(values[0]);
    for (std::size_t i = 0; i < values.size(); i += lanes)
        for (std::size_t j = 0; j < lanes; ++j) {
            const float v = values[i + j];
            low[j] = v < low[j] ? v : low[j];
            high[j] = v > high[j] ? v : high[j];
        }
    return {rangeOf(low).min, rangeOf(high).max};
}

Vec3i blockOf(Vec3i voxel) { return {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3}; }

void addCube(Box3d& box, Vec3i lowest, int size) {
    box.add(lowest.as<double>());
    box.add(lowest.as<double>() + Vec3d{1, 1, 1} * (size - 1.0));
}

bool containsLeaf(const Box3d& box, Vec3i origin) {
    return box.contains(origin.as<double>()) &&
           box.contains((origin + Vec3i{7, 7, 7}).as<double>());
}

}  // namespace

class FieldBuilder {
public:
    FieldBuilder(const FieldSource& source, Storage storage) : source_(source) {
        field_.channels_ = source.channels;
        field_.background_ = source.background;
        if (source.within)
            field_.limits_ = Box3d{source.within->lower.as<double>() - Vec3d{1, 1, 1},
                                   source.within->upper.as<double>() + Vec3d{1, 1, 1}};
        field_.brickRanges_.resize(source.leafOrigins.size());
        if (storage == Storage::Auto) storage = survivesHalf() ? Storage::Half : Storage::Float;
        field_.storage_ = storage;
        if (storage == Storage::Half)
            copyAsHalf();
        else if (storage == Storage::Fixed16)
            copyAsFixed(field_.words_);
        else if (storage == Storage::Fixed8)
            copyAsFixed(field_.bytes_);
        else
            copyAsFloat();
        placeBlocks();
        findRange();
        findSupport();
    }
    Field take() { return std::move(field_); }

private:
    std::size_t brickValues() const { return 512 * field_.channelCount(); }

    /// Calls f(leaf, its values) for all leaves in parallel.
    template <class F>
    void forEachLeaf(F&& f) const {
        tbb::parallel_for(std::size_t{0}, source_.leafOrigins.size(), [&](std::size_t i) {
            std::array<float, 3 * 512> values;
            source_.copyLeaf(i, {values.data(), brickValues()});
            f(i, std::span<const float>(values.data(), brickValues()));
        });
    }

    bool survivesHalf() const {
        std::atomic<bool> exact{true};
        forEachLeaf([&](std::size_t, std::span<const float> values) {
            if (exact.load(std::memory_order_relaxed) &&
                !std::all_of(values.begin(), values.end(), isExactAsHalf))
                exact.store(false, std::memory_order_relaxed);
        });
        return exact;
    }

    void copyAsFloat() {
        const std::size_t n = source_.leafOrigins.size();
        field_.floats_ = largeArray<float>(n * brickValues());
        tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
            const std::span<float> brick(&field_.floats_[i * brickValues()], brickValues());
            source_.copyLeaf(i, brick);
            field_.brickRanges_[i] = rangeOfBrick(brick);
        });
    }

    void copyAsHalf() {
        const std::size_t n = source_.leafOrigins.size();
        field_.words_ = largeArray<std::uint16_t>(n * brickValues());
        std::atomic<bool> overflow{false};
        forEachLeaf([&](std::size_t i, std::span<const float> values) {
            const Range exact = rangeOfBrick(values);
            if (!(exact.min >= -largestHalf && exact.max <= largestHalf)) {
                overflow = true;
                return;
            }
            const auto rounded = [](float v) { return decodeHalf(encodeHalf(v)); };
            field_.brickRanges_[i] = {rounded(exact.min), rounded(exact.max)};  // rounds in order
            std::transform(values.begin(), values.end(), &field_.words_[i * brickValues()],
                           encodeHalf);
        });
        if (overflow)
            throw inputError("a voxel exceeds {}, the largest half; use float storage",
                             largestHalf);
    }

    template <class Code>
    void copyAsFixed(std::unique_ptr<Code[]>& codes) {
        constexpr unsigned last = std::numeric_limits<Code>::max();
        const std::size_t n = source_.leafOrigins.size(), channels = field_.channelCount();
        codes = largeArray<Code>(n * brickValues());
        field_.scales_.resize(n * channels);
        std::vector<float> errors(n);
        forEachLeaf([&](std::size_t i, std::span<const float> values) {
            for (std::size_t c = 0; c < channels; ++c) {
                Range exact{values[c], values[c]};
                for (std::size_t j = c; j < values.size(); j += channels)
                    exact.add({values[j], values[j]});
                const FixedScale scale = FixedScale::of(exact.min, exact.max, last);
                field_.scales_[i * channels + c] = scale;
                const auto stored = [&](float v) { return scale.value(scale.code(v, last)); };
                const Range range{stored(exact.min), stored(exact.max)};  // rounds in order
                if (c == 0) field_.brickRanges_[i] = range;
                field_.brickRanges_[i].add(range);
                for (std::size_t j = c; j < values.size(); j += channels) {
                    const unsigned code = scale.code(values[j], last);
                    codes[i * brickValues() + j] = static_cast<Code>(code);
                    errors[i] = std::max(errors[i], std::abs(scale.value(code) - values[j]));
                }
            }
        });
        for (float error : errors)
            field_.largestFixedError_ = std::max(field_.largestFixedError_, error);
    }

    void placeBlocks() {
        Box3i bounds{{INT32_MAX, INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN, INT32_MIN}};
        const auto cover = [&](Vec3i origin, int size) {
            const int n = size / 8 - 1;
            bounds.lower = min(bounds.lower, blockOf(origin));
            bounds.upper = max(bounds.upper, blockOf(origin) + Vec3i{n, n, n});
        };
        for (Vec3i o : source_.leafOrigins) cover(o, 8);
        for (const FieldTile& t : source_.tiles) cover(t.origin, t.size);

        const std::uint32_t outside = addConstant(source_.background);
        if (bounds.empty()) {
            field_.table_ = BlockTable<std::uint32_t>({}, outside, false);
            return;
        }
        const double volume = (1.0 + bounds.upper.x - bounds.lower.x) *
                              (1.0 + bounds.upper.y - bounds.lower.y) *
                              (1.0 + bounds.upper.z - bounds.lower.z);
        const std::size_t regions = countCubes(regionLog2), supers = countCubes(superLog2);
        const bool dense = volume * sizeof(std::uint32_t) <=
                           static_cast<double>(field_.table_.sparseBytes(regions, supers));
        field_.table_ = BlockTable<std::uint32_t>(bounds, outside, dense);
        if (!dense) field_.table_.reserve(regions, supers);

        for (const FieldTile& t : source_.tiles)
            field_.table_.fill(blockOf(t.origin), std::countr_zero(static_cast<unsigned>(t.size)),
                               addConstant(t.value));
        for (std::size_t i = 0; i < source_.leafOrigins.size(); ++i)
            field_.table_.at(blockOf(source_.leafOrigins[i])) = static_cast<std::uint32_t>(i);
        field_.table_.shrink();
    }

    /// Neighbours of equal value share one constant.
    std::uint32_t addConstant(const std::array<float, 3>& value) {
        std::vector<float>& constants = field_.constants_;
        const auto channels = static_cast<std::ptrdiff_t>(field_.channelCount());
        if (constants.empty() ||
            !std::equal(constants.end() - channels, constants.end(), value.begin()))
            constants.insert(constants.end(), value.begin(), value.begin() + channels);
        return Field::constantBit |
               static_cast<std::uint32_t>(constants.size() / field_.channelCount() - 1);
    }

    /// Aligned cubes of 2^log2Size voxels that hold leaves.
    std::size_t countCubes(int log2Size) const {
        std::unordered_set<std::uint64_t> cubes;
        std::uint64_t last = ~std::uint64_t{0};
        for (const Vec3i o : source_.leafOrigins) {
            const auto part = [&](int v) {
                return static_cast<std::uint64_t>(v >> log2Size) & 0x1fffffu;
            };
            const std::uint64_t cube = part(o.x) | part(o.y) << 21 | part(o.z) << 42;
            if (cube != last) cubes.insert(cube);
            last = cube;
        }
        return cubes.size();
    }

    void findRange() {
        field_.range_ = rangeOf(field_.constants_);
        for (const Range& r : field_.brickRanges_) field_.range_.add(r);
    }

    /// Trims the support to the voxels that differ from the background, so that rays start and end
    /// where the medium does.
    void findSupport() {
        Box3d blocks, box;
        for (const FieldTile& t : source_.tiles)
            if (!std::equal(t.value.begin(), t.value.begin() + source_.channels,
                            source_.background.begin()))
                addCube(box, t.origin, t.size);
        for (Vec3i o : source_.leafOrigins) addCube(blocks, o, 8);
        const auto isOutermost = [&](Vec3i o) {
            bool atEdge = false;
            for (int axis = 0; axis < 3; ++axis)
                atEdge |= o[axis] == blocks.lower[axis] || o[axis] + 7 == blocks.upper[axis];
            return atEdge;
        };
        // The outermost leaves first: then few others have voxels outside of the box.
        for (const bool outermost : {true, false})
            box = tbb::parallel_reduce(
                tbb::blocked_range<std::size_t>(0, source_.leafOrigins.size(), 256), box,
                [&](const tbb::blocked_range<std::size_t>& range, Box3d part) {
                    for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        const Vec3i o = source_.leafOrigins[i];
                        if (isOutermost(o) == outermost && !containsLeaf(part, o))
                            coverBrick(i, part);
                    }
                    return part;
                },
                [](Box3d a, const Box3d& b) {
                    a.add(b);
                    return a;
                });
        if (!box.empty())
            field_.support_ = {box.lower - Vec3d{1, 1, 1}, box.upper + Vec3d{1, 1, 1}};
    }
    void coverBrick(std::size_t brick, Box3d& box) const {
        Box3i inside{{8, 8, 8}, {-1, -1, -1}};
        for (int i = 0; i < 512; ++i) {
            const Vec3i v{i >> 6, i >> 3 & 7, i & 7};
            bool differs = false;
            for (int c = 0; c < field_.channels_; ++c)
                differs |=
                    field_.valueOf(static_cast<std::uint32_t>(brick), v, c) != field_.background(c);
            if (differs) inside = {min(inside.lower, v), max(inside.upper, v)};
        }
        if (inside.empty()) return;
        box.add((source_.leafOrigins[brick] + inside.lower).as<double>());
        box.add((source_.leafOrigins[brick] + inside.upper).as<double>());
    }

    const FieldSource& source_;
    Field field_;
};

Field buildField(const FieldSource& source, Storage storage) {
    return FieldBuilder(source, storage).take();
}

Range Field::storedRange(std::uint32_t ref) const {
    if (!(ref & constantBit)) return brickRanges_[ref];
    return rangeOf({&constants_[(ref & ~constantBit) * channelCount()], channelCount()});
}

Range Field::storedRange(std::uint32_t ref, Vec3i n) const {
    if (ref & constantBit) return storedRange(ref);
    const float first = valueOf(ref, {0, 0, 0}, 0);
    Range r{first, first};
    for (int x = 0; x < n.x; ++x)
        for (int y = 0; y < n.y; ++y)
            for (int z = 0; z < n.z; ++z)
                for (int c = 0; c < channels_; ++c) {
                    const float v = valueOf(ref, {x, y, z}, c);
                    r.add({v, v});
                }
    return r;
}

std::size_t Field::bytes() const {
    const std::size_t bytesPerValue = storage_ == Storage::Float    ? 4
                                      : storage_ == Storage::Fixed8 ? 1
                                                                    : 2;
    return sizeof(*this) - sizeof(table_) + table_.bytes() + constants_.capacity() * sizeof(float) +
           scales_.capacity() * sizeof(FixedScale) +
           brickCount() * (sizeof(Range) + 512 * channelCount() * bytesPerValue);
}

}  // namespace woodcock::grid
