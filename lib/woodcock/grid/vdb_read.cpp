// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb_read.h"

#include <openvdb/openvdb.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "woodcock/base/error.h"
#include "woodcock/grid/half.h"
#include "woodcock/grid/vdb_header.h"
#include "woodcock/grid/vdb_types.h"

namespace woodcock {

namespace {

template <class V>
constexpr int channelsOf = openvdb::VecTraits<V>::IsVec ? 3 : 1;

/// What lies beyond the range of float becomes infinite, and is then refused or repaired as such.
float toFloat(double v) {
    if (std::abs(v) <= static_cast<double>(std::numeric_limits<float>::max()) || std::isnan(v))
        return static_cast<float>(v);
    return std::copysign(std::numeric_limits<float>::infinity(), v < 0 ? -1.0f : 1.0f);
}

template <class V>
void convert(const V& value, float* to) {
    if constexpr (channelsOf<V> == 3) {
        for (int c = 0; c < 3; ++c) to[c] = toFloat(static_cast<double>(value[c]));
    } else if constexpr (std::is_same_v<V, float>) {
        *to = value;
    } else {
        *to = toFloat(static_cast<double>(value));
    }
}

template <class V>
std::array<float, 3> converted(const V& value) {
    std::array<float, 3> v{};
    convert(value, v.data());
    return v;
}

template <class V>
constexpr bool isMadeOfFloats = std::is_same_v<V, float> || std::is_same_v<V, openvdb::Vec3f>;

template <class Leaf>
void copyValues(const Leaf& leaf, float* to) {
    using V = typename Leaf::ValueType;
    if constexpr (isMadeOfFloats<V>) {
        std::memcpy(to, leaf.buffer().data(), 512 * sizeof(V));
    } else {
        for (openvdb::Index n = 0; n < 512; ++n)
            convert<V>(leaf.getValue(n), to + n * channelsOf<V>);
    }
}

Vec3i toVec(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

/// Turns one kind of tree into a source, its leaves in parallel.
template <class TreeT>
class TreeReader {
public:
    using Leaf = typename TreeT::LeafNodeType;
    using Value = typename TreeT::ValueType;
    static constexpr int channels = channelsOf<Value>;

    TreeReader(typename openvdb::Grid<TreeT>::ConstPtr grid, Repair repair)
        : grid_(std::move(grid)), repair_(repair) {}

    GridSource read() {
        source_.field.channels = channels;
        source_.field.background = source_.statistics.background =
            converted(grid_->tree().background());
        scanLeaves();
        scanTiles();
        describe();
        if (repair_.faulty) {
            repairValues(source_.field.background, repair_.negative);
            for (FieldTile& tile : source_.field.tiles) repairValues(tile.value, repair_.negative);
        }
        return std::move(source_);
    }

private:
    void scanLeaves() {
        auto leaves = std::make_shared<std::vector<const Leaf*>>();
        leaves->reserve(grid_->tree().leafCount());
        grid_->tree().getNodes(*leaves);
        std::vector<LeafKind> kinds(leaves->size());
        // Deterministic, so that the mean of a grid is the same number each time.
        source_.statistics.voxels = tbb::parallel_deterministic_reduce(
            tbb::blocked_range<std::size_t>(0, leaves->size(), 128), VoxelScan{},
            [&](const tbb::blocked_range<std::size_t>& range, VoxelScan scan) {
                for (std::size_t i = range.begin(); i != range.end(); ++i)
                    kinds[i] = scanOne(*(*leaves)[i], scan);
                return scan;
            },
            [](VoxelScan a, const VoxelScan& b) {
                a.add(b);
                return a;
            });
        source_.statistics.leaves = leaves->size();
        keepVarying(*leaves, kinds);
        source_.field.copyLeaf = [grid = grid_, leaves, repair = repair_](std::size_t i,
                                                                          std::span<float> values) {
            copyValues(*(*leaves)[i], values.data());
            if (repair.faulty) repairValues(values, repair.negative);
        };
    }

    LeafKind scanOne(const Leaf& leaf, VoxelScan& scan) const {
        std::array<float, 512 * channels> converted;
        std::span<const float> values = converted;
        if constexpr (isMadeOfFloats<Value>)
            values = {reinterpret_cast<const float*>(leaf.buffer().data()), converted.size()};
        else
            copyValues(leaf, converted.data());
        std::array<std::uint64_t, 8> mask;
        for (openvdb::Index w = 0; w < 8; ++w)
            mask[w] = leaf.getValueMask().template getWord<std::uint64_t>(w);
        return scanLeaf(values, channels, mask, toVec(leaf.origin()), source_.field.background,
                        scan);
    }

    /// Leaves that say no more than a tile become one; those equal to the background vanish.
    void keepVarying(std::vector<const Leaf*>& leaves, const std::vector<LeafKind>& kinds) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            const Vec3i origin = toVec(leaves[i]->origin());
            if (kinds[i] == LeafKind::Constant)
                source_.field.tiles.push_back(
                    {origin, 8, converted(Value(leaves[i]->getValue(0)))});
            if (kinds[i] != LeafKind::Varying) continue;
            source_.field.leafOrigins.push_back(origin);
            leaves[kept++] = leaves[i];
        }
        leaves.resize(kept);
    }

    void scanTiles() {
        using Upper = typename TreeT::RootNodeType::ChildNodeType;
        using Lower = typename Upper::ChildNodeType;
        for (auto it = grid_->tree().root().cbeginValueAll(); it; ++it)
            addTile(*it, it.isValueOn(), it.getCoord(), Upper::DIM);
        addTilesOf<Upper>();
        addTilesOf<Lower>();
    }

    /// Most tiles of most nodes are background: those that are not are found in parallel.
    template <class Node>
    void addTilesOf() {
        std::vector<const Node*> nodes;
        grid_->tree().getNodes(nodes);
        std::vector<std::vector<openvdb::Index>> tiles(nodes.size());
        const Value background = grid_->tree().background();
        tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
            const auto* table = nodes[i]->getTable();
            const auto& children = nodes[i]->getChildMask();
            const auto& active = nodes[i]->getValueMask();
            for (openvdb::Index n = 0; n < Node::NUM_VALUES; ++n)
                if (!children.isOn(n) && (active.isOn(n) || table[n].getValue() != background))
                    tiles[i].push_back(n);
        });
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (openvdb::Index n : tiles[i])
                addTile(nodes[i]->getTable()[n].getValue(), nodes[i]->isValueMaskOn(n),
                        nodes[i]->offsetToGlobalCoord(n), Node::ChildNodeType::DIM);
    }

    void addTile(const Value& value, bool active, const openvdb::Coord& origin,
                 openvdb::Index size) {
        if (!active && value == grid_->tree().background()) return;
        const FieldTile tile{toVec(origin), static_cast<int>(size), converted(value)};
        scanTile(tile.value, channels, active, tile.origin, tile.size, source_.field.background,
                 source_.statistics.voxels);
        source_.statistics.activeTiles += active;
        if (tile.value != source_.field.background) source_.field.tiles.push_back(tile);
    }

    void describe() {
        source_.statistics.openVdbBytes = grid_->memUsage();
        const openvdb::CoordBBox box = grid_->evalActiveVoxelBoundingBox();
        if (!box.empty()) source_.statistics.activeBounds = {toVec(box.min()), toVec(box.max())};
        bool& exactAsHalf = source_.statistics.voxels.exactAsHalf;
        for (float v : source_.statistics.background) exactAsHalf = exactAsHalf && isExactAsHalf(v);
    }

    typename openvdb::Grid<TreeT>::ConstPtr grid_;
    Repair repair_;
    GridSource source_;
};

template <class TreeT>
bool readAs(const openvdb::GridBase::Ptr& grid, Repair repair, GridSource& source) {
    const auto typed = openvdb::gridPtrCast<openvdb::Grid<TreeT>>(grid);
    if (!typed) return false;
    source = TreeReader<TreeT>(typed, repair).read();
    return true;
}

template <class... TreeT>
bool readAsOneOf(const openvdb::GridBase::Ptr& grid, Repair repair, GridSource& source) {
    return (readAs<TreeT>(grid, repair, source) || ...);
}

}  // namespace

GridSource readGridSource(const VdbFile& file, const GridListing& grid, Repair repair) {
    const VdbHeader header = readVdbHeader(file.path);
    GridSource source;
    withOpenVdbErrors(file.path, [&] {
        openvdb::GridBase::Ptr read;
        {
            const OpenVdbTypes types(header);
            openvdb::io::File vdb(file.path.string());
            // Leaves that are read later can be read in parallel, but each then costs a stream and
            // a look at the file's date: on few cores that takes longer, on many it gains little.
            vdb.open(/*delayLoad=*/false);
            read = vdb.readGrid(grid.uniqueName);
        }
        using namespace openvdb;
        if (!readAsOneOf<FloatTree, DoubleTree, Int32Tree, Int64Tree, BoolTree, MaskTree, Vec3STree,
                         Vec3DTree, Vec3ITree>(read, repair, source))
            throw inputError("grid '{}' in {} has type {}, which holds no values to render",
                             grid.uniqueName, file.path.string(), grid.valueType);
    });
    return source;
}

}  // namespace woodcock
