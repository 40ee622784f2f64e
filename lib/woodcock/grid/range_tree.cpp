// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/range_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>

namespace woodcock::grid {

namespace {

constexpr int cellLog2 = 2;  // of the smallest cubes

using Eighths = std::array<Range, 8>;

constexpr Range nothing{std::numeric_limits<float>::infinity(),
                        -std::numeric_limits<float>::infinity()};

/// Calls f with the values of a voxel of a block.
template <class F>
void forValues(const Field& field, const Field::BlockVoxels& block, Vec3i v, int channel, F f) {
    if (channel != RangeTree::allChannels) return f(block(v, channel));
    for (int c = 0; c < field.channels(); ++c) f(block(v, c));
}

/// The ranges of a brick's parts of 4^3 voxels, x first.
Eighths eighthsOf(const Field& field, Vec3i block, int channel) {
    const Field::BlockVoxels voxels(field, block);
    Eighths parts;
    parts.fill(nothing);
    for (int i = 0; i < 512; ++i) {
        const Vec3i v{i >> 6, i >> 3 & 7, i & 7};
        Range& part = parts[static_cast<std::size_t>(v.x >> 2 | v.y >> 2 << 1 | v.z >> 2 << 2)];
        forValues(field, voxels, v, channel, [&](float value) { part.add({value, value}); });
    }
    return parts;
}

bool within(Range inner, Range outer) { return inner.min >= outer.min && inner.max <= outer.max; }

template <class T>
Vec3<T> partOf(std::size_t i, T size) {
    return {i & 1 ? size : 0, i & 2 ? size : 0, i & 4 ? size : 0};
}

}  // namespace

class RangeTree::Builder {
public:
    explicit Builder(RangeTree& tree) : tree_(tree) {
        const Field& field = *tree.field_;
        const auto& blocks = field.blocks();
        std::vector<Vec3i> bricks;
        std::vector<Cube> cubes;
        Corner lower{}, upper{};
        blocks.forEach([&](Vec3i b, int log2Size, std::uint32_t ref) {
            if (ref == blocks.outside()) return;
            const Corner corner = b.as<std::int64_t>() * 8;
            const std::int64_t size = std::int64_t{1} << log2Size;
            const Corner end = corner + Corner{size, size, size};
            lower = cubes.empty() ? corner : min(lower, corner);
            upper = cubes.empty() ? end : max(upper, end);
            Range range = field.storedRange(ref);
            const bool varies = range.min < range.max && log2Size == blockLog2;
            if (!varies) range = valuesOf(field, b);
            cubes.push_back(
                {corner, log2Size, range, varies ? static_cast<std::int64_t>(bricks.size()) : -1});
            if (varies) bricks.push_back(b);
        });
        if (cubes.empty()) return;
        eighths_.resize(bricks.size());
        tbb::parallel_for(std::size_t{0}, bricks.size(), [&](std::size_t i) {
            eighths_[i] = eighthsOf(field, bricks[i], tree.channel_);
        });
        // Tiles are aligned to their size, 4096 at most.
        const std::int64_t step = std::int64_t{1} << superLog2;
        tree.origin_ = {lower.x & -step, lower.y & -step, lower.z & -step};
        const Corner reach = upper - tree.origin_;
        const auto widest = static_cast<std::uint64_t>(std::max({reach.x, reach.y, reach.z}));
        tree.log2Size_ = static_cast<int>(std::bit_width(widest - 1));
        for (Cube& cube : cubes) cube.corner = cube.corner - tree.origin_;
        tree.nodes_.emplace_back();
        fill(0, {}, tree.log2Size_, cubes);
        tree.nodes_.shrink_to_fit();
    }

private:
    /// The range of a block of one value for each channel.
    Range valuesOf(const Field& field, Vec3i block) const {
        Range range = nothing;
        forValues(field, Field::BlockVoxels(field, block), {}, tree_.channel_, [&](float value) {
            range.add({value, value});
        });
        return range;
    }

    /// Makes the node of the cube at `corner` and all below it, from the cubes that lie in it.
    void fill(std::size_t node, Corner corner, int log2Size, std::span<Cube> cubes) {
        if (cubes.empty()) {
            tree_.nodes_[node] = {tree_.outside_, none};
            return;
        }
        if (cubes.size() == 1 && cubes[0].log2Size == log2Size) {
            fillWithCube(node, cubes[0]);
            return;
        }
        const std::int64_t half = std::int64_t{1} << (log2Size - 1);
        const std::size_t first = addChildren(node);
        for (std::size_t i = 0; i < 8; ++i) {
            const Corner from = corner + partOf<std::int64_t>(i, half);
            const auto end = std::partition(cubes.begin(), cubes.end(), [&](const Cube& c) {
                return c.corner.x >= from.x && c.corner.x < from.x + half && c.corner.y >= from.y &&
                       c.corner.y < from.y + half && c.corner.z >= from.z &&
                       c.corner.z < from.z + half;
            });
            fill(first + i, from, log2Size - 1, {cubes.begin(), end});
            cubes = {end, cubes.end()};
        }
        takeRange(node);
    }

    void fillWithCube(std::size_t node, const Cube& cube) {
        tree_.nodes_[node] = {cube.range, even};
        if (cube.brick < 0) return;
        const std::size_t first = addChildren(node);
        const Eighths& parts = eighths_[static_cast<std::size_t>(cube.brick)];
        for (std::size_t i = 0; i < 8; ++i)
            tree_.nodes_[first + i] = {parts[i], parts[i].min < parts[i].max ? mixed : even};
        takeRange(node);
    }

    std::size_t addChildren(std::size_t node) {
        const std::size_t first = tree_.nodes_.size();
        tree_.nodes_[node].child = static_cast<std::int32_t>(first);
        tree_.nodes_.resize(first + 8);
        return first;
    }
    void takeRange(std::size_t node) {
        Range range = nothing;
        const auto first = static_cast<std::size_t>(tree_.nodes_[node].child);
        for (std::size_t i = 0; i < 8; ++i) range.add(tree_.nodes_[first + i].range);
        tree_.nodes_[node].range = range;
    }

    RangeTree& tree_;
    std::vector<Eighths> eighths_;
};

RangeTree::RangeTree(std::shared_ptr<const Field> field, int channel)
    : field_(std::move(field)), channel_(channel), outside_(nothing) {
    for (int c = 0; c < field_->channels(); ++c)
        if (channel == allChannels || channel == c)
            outside_.add({field_->background(c), field_->background(c)});
    Builder builder(*this);
}

Range RangeTree::range(const Box3i& box) const {
    Query q{box.lower.as<std::int64_t>() - origin_,
            box.upper.as<std::int64_t>() - origin_ + Corner{1, 1, 1}, 0, nothing};
    const Corner size = q.upper - q.lower;
    const auto widest = static_cast<std::uint64_t>(std::max({size.x, size.y, size.z}));
    q.finest = static_cast<int>(std::bit_width(widest)) - 3;
    const std::int64_t all = std::int64_t{1} << log2Size_;
    if (nodes_.empty() || std::min({q.lower.x, q.lower.y, q.lower.z}) < 0 ||
        std::max({q.upper.x, q.upper.y, q.upper.z}) > all)
        q.range.add(outside_);
    if (!nodes_.empty()) look(nodes_.front(), {}, log2Size_, q);
    return q.range;
}

bool RangeTree::meets(const Query& q, Corner corner, std::int64_t size) {
    for (int i = 0; i < 3; ++i)
        if (corner[i] >= q.upper[i] || corner[i] + size <= q.lower[i]) return false;
    return true;
}

bool RangeTree::isOutside(const Box3i& box) const {
    const Query q{box.lower.as<std::int64_t>() - origin_,
                  box.upper.as<std::int64_t>() - origin_ + Corner{1, 1, 1}, 0, nothing};
    return nodes_.empty() || isOutside(nodes_.front(), {}, std::int64_t{1} << log2Size_, q);
}

bool RangeTree::isOutside(const Node& node, Corner corner, std::int64_t size,
                          const Query& q) const {
    if (node.child == none || !meets(q, corner, size)) return true;
    if (node.child == even || node.child == mixed) return false;
    for (std::size_t i = 0; i < 8; ++i)
        if (!isOutside(nodes_[static_cast<std::size_t>(node.child) + i],
                       corner + partOf<std::int64_t>(i, size / 2), size / 2, q))
            return false;
    return true;
}

void RangeTree::look(const Node& node, Corner corner, int log2Size, Query& q) const {
    const std::int64_t size = std::int64_t{1} << log2Size;
    if (!meets(q, corner, size) || within(node.range, q.range)) return;
    bool inside = true;
    for (int i = 0; i < 3; ++i) inside &= corner[i] >= q.lower[i] && corner[i] + size <= q.upper[i];
    if (inside || node.child == even || node.child == none ||
        (log2Size <= q.finest && log2Size >= cellLog2)) {
        q.range.add(node.range);
        return;
    }
    if (node.child == mixed) {
        lookAtVoxels(corner, q);
        return;
    }
    for (std::size_t i = 0; i < 8; ++i)
        look(nodes_[static_cast<std::size_t>(node.child) + i],
             corner + partOf<std::int64_t>(i, size / 2), log2Size - 1, q);
}

void RangeTree::lookAtVoxels(Corner corner, Query& q) const {
    const std::int64_t size = std::int64_t{1} << cellLog2;
    const Vec3i from = (max(corner, q.lower) + origin_).as<int>();
    const Vec3i end = (min(corner + Corner{size, size, size}, q.upper) + origin_).as<int>();
    const Field::BlockVoxels block(*field_, {from.x >> 3, from.y >> 3, from.z >> 3});
    for (int x = from.x; x < end.x; ++x)
        for (int y = from.y; y < end.y; ++y)
            for (int z = from.z; z < end.z; ++z)
                forValues(*field_, block, {x, y, z}, channel_, [&](float v) {
                    q.range.add({v, v});
                });
}

}  // namespace woodcock::grid
