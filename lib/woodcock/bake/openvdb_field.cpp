// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/openvdb_field.h"

#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::bake {

namespace {

Vec3i toVec(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }
std::array<float, 3> values(float v) { return {v, 0, 0}; }
std::array<float, 3> values(const openvdb::Vec3s& v) { return {v.x(), v.y(), v.z()}; }

template <class Tree>
grid::Field build(const Tree& tree) {
    using Leaf = typename Tree::LeafNodeType;
    constexpr int channels = sizeof(typename Tree::ValueType) / sizeof(float);
    grid::FieldSource source;
    source.channels = channels;
    source.background = values(tree.background());
    std::vector<const Leaf*> leaves;
    tree.getNodes(leaves);
    for (const Leaf* leaf : leaves) source.leafOrigins.push_back(toVec(leaf->origin()));
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (*tile == tree.background()) continue;
        openvdb::CoordBBox box;
        tile.getBoundingBox(box);
        source.tiles.push_back({toVec(box.min()), box.dim().x(), values(*tile)});
    }
    source.copyLeaf = [&](std::size_t i, std::span<float> out) {
        const auto* data = reinterpret_cast<const float*>(leaves[i]->buffer().data());
        std::copy_n(data, out.size(), out.data());
    };
    return grid::buildField(source, grid::Storage::Float);
}

}  // namespace

grid::Field fieldOf(const openvdb::GridBase& grid) {
    if (const auto* scalars = dynamic_cast<const openvdb::FloatGrid*>(&grid))
        return build(scalars->tree());
    return build(dynamic_cast<const openvdb::Vec3SGrid&>(grid).tree());
}

}  // namespace woodcock::bake
