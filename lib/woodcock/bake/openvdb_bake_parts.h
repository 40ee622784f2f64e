// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "woodcock/bake/baker.h"
#include "woodcock/grid/vdb/openvdb_trees.h"
#include "woodcock/grid/voxel_scan.h"

namespace woodcock::bake {

// The results of a bake's threads, until they are joined.

/// A cube of voxels in index space.
struct Region {
    Vec3i origin;  ///< a multiple of size
    int size;
    Vec3i last() const { return origin + Vec3i{1, 1, 1} * (size - 1); }
};

template <class Tree>
typename Tree::ValueType treeValue(const std::array<float, 3>& v);
template <>
inline float treeValue<openvdb::FloatTree>(const std::array<float, 3>& v) {
    return v[0];
}
template <>
inline openvdb::Vec3s treeValue<openvdb::Vec3STree>(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

/// One thread's part of one output.
template <class Tree>
struct Parts {
    using Leaf = typename Tree::LeafNodeType;
    struct Tile {
        openvdb::Coord origin;
        int size;
        typename Tree::ValueType value;
    };
    std::vector<std::unique_ptr<Leaf>> leaves;
    std::vector<Tile> tiles;

    void add(const Region& region, const std::array<float, 3>& value) {
        const int size = region.size >= 4096 ? 4096 : region.size >= 128 ? 128 : 8;
        for (int x = 0; x < region.size; x += size)
            for (int y = 0; y < region.size; y += size)
                for (int z = 0; z < region.size; z += size)
                    tiles.push_back({openvdb::Coord(region.origin.x + x, region.origin.y + y,
                                                    region.origin.z + z),
                                     size, treeValue<Tree>(value)});
    }
    void add(Vec3i origin, const std::array<std::array<float, 512>, 3>& values,
             const std::array<std::uint64_t, 8>& active) {
        auto leaf = std::make_unique<Leaf>(openvdb::Coord(origin.x, origin.y, origin.z),
                                           treeValue<Tree>({0, 0, 0}));
        typename Tree::ValueType* const data = leaf->buffer().data();
        for (std::size_t i = 0; i < 512; ++i)
            if (active[i / 64] >> (i % 64) & 1)
                data[i] = treeValue<Tree>({values[0][i], values[1][i], values[2][i]});
        typename Leaf::NodeMaskType mask;
        for (openvdb::Index w = 0; w < 8; ++w) mask.template getWord<std::uint64_t>(w) = active[w];
        leaf->setValueMask(mask);
        leaves.push_back(std::move(leaf));
    }
};

struct OutputParts {
    std::variant<Parts<openvdb::FloatTree>, Parts<openvdb::Vec3STree>> parts;
    BakedGridStatistics statistics;
    grid::VoxelCount faulty;
    double greatestAnywhere = 0;  ///< of the absolute values, left out ones included

    explicit OutputParts(int channels) {
        if (channels == 3) parts.emplace<1>();
        statistics.least = std::numeric_limits<double>::infinity();
        statistics.greatest = -statistics.least;
    }
    void addRange(double v) {
        statistics.least = std::min(statistics.least, v);
        statistics.greatest = std::max(statistics.greatest, v);
    }
    void add(const OutputParts& other) {
        statistics.least = std::min(statistics.least, other.statistics.least);
        statistics.greatest = std::max(statistics.greatest, other.statistics.greatest);
        greatestAnywhere = std::max(greatestAnywhere, other.greatestAnywhere);
        faulty.add(other.faulty);
        for (std::size_t i = 0; i < 6; ++i) statistics.atBounds[i] += other.statistics.atBounds[i];
    }
};

/// Joins the parts of all threads into one tree.
template <class Grid, class P>
openvdb::GridBase::Ptr makeGrid(const std::vector<P*>& parts, double tolerance) {
    auto grid = Grid::create();
    auto& tree = grid->tree();
    for (P* part : parts) {
        for (const auto& tile : part->tiles)
            tree.addTile(tile.size == 4096  ? 3
                         : tile.size == 128 ? 2
                                            : 1,
                         tile.origin, tile.value, true);
        for (auto& leaf : part->leaves) tree.addLeaf(leaf.release());
        *part = {};
    }
    openvdb::tools::prune(tree, typename Grid::ValueType(static_cast<float>(tolerance)));
    return grid;
}

}  // namespace woodcock::bake
