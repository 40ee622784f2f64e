// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "woodcock/grid/field.h"

namespace woodcock::grid {

/// The ranges of a field's voxels as an octree, down to cubes of 4^3 voxels: so those of any box
/// are found by a look at few nodes.
class RangeTree {
public:
    /// Of one channel's values; `allChannels`: of all values together.
    static constexpr int allChannels = -1;
    explicit RangeTree(std::shared_ptr<const Field> field, int channel = allChannels);

    /// Bounds of the voxels in `box` (index space). They are exact where the box is narrower than
    /// 16 voxels. Of a larger one, they may be those of a box that is wider by a quarter.
    Range range(const Box3i& box) const;
    /// True where no voxel in `box` belongs to a leaf or a tile: all are the background.
    bool isOutside(const Box3i& box) const;
    const Field& field() const { return *field_; }
    std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

private:
    /// A cube. `child` is the first of its eight parts, in nodes_.
    struct Node {
        Range range;
        std::int32_t child = even;
    };
    static constexpr std::int32_t even = -1;   ///< all its voxels have the range
    static constexpr std::int32_t mixed = -2;  ///< 4^3 voxels to be looked at
    static constexpr std::int32_t none = -3;   ///< no leaf or tile reaches into it
    using Corner = Vec3<std::int64_t>;
    /// A brick, or a cube of one value; the first voxel relative to that of the root.
    struct Cube {
        Corner corner;
        int log2Size;
        Range range;
        std::int64_t brick;  ///< in the ranges of all bricks' eighths; -1: one value
    };

    class Builder;
    /// A box, relative to the root, without its upper faces.
    struct Query {
        Corner lower, upper;
        int finest;  ///< log2 of the smallest cubes that are told apart
        Range range;
    };
    static bool meets(const Query& q, Corner corner, std::int64_t size);
    bool isOutside(const Node& node, Corner corner, std::int64_t size, const Query& q) const;
    void look(const Node& node, Corner corner, int log2Size, Query& q) const;
    void lookAtVoxels(Corner corner, Query& q) const;

    std::shared_ptr<const Field> field_;
    int channel_;
    Range outside_;
    Corner origin_{};  // of the root
    int log2Size_ = 0;
    std::vector<Node> nodes_;  // the root first; none: all is outside
};

}  // namespace woodcock::grid
