// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/read_voxels.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "woodcock/base/error.h"
#include "woodcock/grid/half.h"
#include "woodcock/grid/nanovdb/file.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_stored_tree.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::grid {

namespace {

template <class V>
constexpr int channelsOf = openvdb::VecTraits<V>::IsVec ? 3 : 1;

/// Values beyond the range of float become infinite, and are then refused or repaired as such.
float toFloat(double v) {
    if (std::abs(v) <= static_cast<double>(std::numeric_limits<float>::max()) || std::isnan(v))
        return static_cast<float>(v);
    return std::copysign(std::numeric_limits<float>::infinity(), v < 0 ? -1.0f : 1.0f);
}

template <class V>
void convert(const V& value, float* to) {
    if constexpr (channelsOf<V> == 3) {
        for (int c = 0; c < 3; ++c) to[c] = toFloat(static_cast<double>(value[c]));
    } else if constexpr (std::is_same_v<V, float> || std::is_same_v<V, openvdb::math::half>) {
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

/// Reads one kind of tree: its nodes one after the other, then its leaves in parallel.
template <class TreeT>
class TreeReader {
public:
    using Leaf = typename TreeT::LeafNodeType;
    using Value = typename TreeT::ValueType;
    static constexpr int channels = channelsOf<Value>;

    /// Of a tree that is stored in a file.
    TreeReader(const StoredTree& stored, Repair repair) : stored_(&stored), repair_(repair) {}
    /// Of a tree in memory, whole.
    TreeReader(std::shared_ptr<TreeT> tree, Repair repair)
        : repair_(repair), tree_(std::move(tree)) {}

    GridSource read() {
        if (stored_) {
            TreeStream stream(*stored_);
            tree_->readTopology(stream, stored_->savedAsHalf);
        }
        source_.field.channels = channels;
        source_.field.background = source_.statistics.background = converted(tree_->background());
        readLeaves();
        scanTiles();
        describe();
        if (repair_.faulty) {
            repairValues(source_.field.background, repair_.negative);
            for (FieldTile& tile : source_.field.tiles) repairValues(tile.value, repair_.negative);
        }
        return std::move(source_);
    }

private:
    void readLeaves() {
        auto leaves = std::make_shared<std::vector<Leaf*>>();
        leaves->reserve(stored_ ? stored_->layout.leaves.size() : tree_->leafCount());
        tree_->getNodes(*leaves);
        if (stored_ && leaves->size() != stored_->layout.leaves.size())
            throw std::runtime_error("the leaves lie elsewhere than the tree says");
        std::vector<LeafKind> kinds(leaves->size());
        // Deterministic, so that the mean of a grid is the same number each time.
        source_.statistics.voxels = tbb::parallel_deterministic_reduce(
            tbb::blocked_range<std::size_t>(0, leaves->size(), 128), VoxelScan{},
            [&](const tbb::blocked_range<std::size_t>& range, VoxelScan scan) {
                if (stored_) readLeavesOf(*leaves, range.begin(), range.end());
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
        source_.field.copyLeaf = [tree = tree_, leaves, repair = repair_](std::size_t i,
                                                                          std::span<float> values) {
            copyValues(*(*leaves)[i], values.data());
            if (repair.faulty) repairValues(values, repair.negative);
        };
    }

    void readLeavesOf(const std::vector<Leaf*>& leaves, std::size_t begin, std::size_t end) const {
        TreeStream stream(*stored_);
        openvdb::io::setGridBackgroundValuePtr(stream, &tree_->background());
        for (std::size_t i = begin; i != end; ++i) readLeafOf(*stored_, stream, i, *leaves[i]);
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

    /// Constant leaves become tiles; leaves equal to the background are dropped.
    void keepVarying(std::vector<Leaf*>& leaves, const std::vector<LeafKind>& kinds) {
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
        for (auto it = tree_->root().cbeginValueAll(); it; ++it)
            addTile(*it, it.isValueOn(), it.getCoord(), Upper::DIM);
        addTilesOf<Upper>();
        addTilesOf<Lower>();
    }

    /// Most tiles of most nodes are background; the others are found in parallel.
    template <class Node>
    void addTilesOf() {
        std::vector<const Node*> nodes;
        tree_->getNodes(nodes);
        std::vector<std::vector<openvdb::Index>> tiles(nodes.size());
        const Value background = tree_->background();
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
        if (!active && value == tree_->background()) return;
        const FieldTile tile{toVec(origin), static_cast<int>(size), converted(value)};
        scanTile(tile.value, channels, active, tile.origin, tile.size, source_.field.background,
                 source_.statistics.voxels);
        source_.statistics.activeTiles += active;
        if (tile.value != source_.field.background) source_.field.tiles.push_back(tile);
    }

    void describe() {
        source_.statistics.openVdbBytes = tree_->memUsage();
        openvdb::CoordBBox box;
        if (tree_->evalActiveVoxelBoundingBox(box))
            source_.statistics.activeBounds = {toVec(box.min()), toVec(box.max())};
        bool& exactAsHalf = source_.statistics.voxels.exactAsHalf;
        for (float v : source_.statistics.background) exactAsHalf = exactAsHalf && isExactAsHalf(v);
    }

    const StoredTree* stored_ = nullptr;
    Repair repair_;
    std::shared_ptr<TreeT> tree_ = std::make_shared<TreeT>();
    GridSource source_;
};

template <class TreeT>
bool readAs(const StoredTree& stored, Repair repair, GridSource& source) {
    if (stored.treeType != TreeT::treeType()) return false;
    source = TreeReader<TreeT>(stored, repair).read();
    return true;
}

template <class... TreeT>
bool readAsOneOf(const StoredTree& stored, Repair repair, GridSource& source) {
    return (readAs<TreeT>(stored, repair, source) || ...);
}

template <class GridT>
bool readAs(openvdb::GridBase& grid, Repair repair, GridSource& source) {
    if (!grid.isType<GridT>()) return false;
    source =
        TreeReader<typename GridT::TreeType>(static_cast<GridT&>(grid).treePtr(), repair).read();
    return true;
}

GridSource readNanoVdbSource(const VdbFile& listed, const GridListing& listing, Repair repair) {
    using namespace openvdb;
    const std::size_t index = indexOf(listed, listing.uniqueName);
    const VdbGrids grids = readNanoVdbGrid(listed.path, index);
    GridBase& grid = *grids.grids.front();
    GridSource source;
    if (readAs<FloatGrid>(grid, repair, source) || readAs<DoubleGrid>(grid, repair, source) ||
        readAs<Int32Grid>(grid, repair, source) || readAs<Int64Grid>(grid, repair, source) ||
        readAs<Vec3SGrid>(grid, repair, source) || readAs<Vec3DGrid>(grid, repair, source))
        return source;
    throw inputError(
        "grid '{}' in {} has values of type {}; expected float, double, int32, int64, vec3s or "
        "vec3d",
        listing.uniqueName, listed.path.string(), grid.valueType());
}

}  // namespace

GridSource readGridSource(const VdbFile& listed, const GridListing& grid, Repair repair) {
    if (listed.nanoVdb) return readNanoVdbSource(listed, grid, repair);
    FileBytes file(listed.path);
    const StoredTree stored = loadStoredTree(file, grid);
    GridSource source;
    try {
        using namespace openvdb;
        if (!readAsOneOf<FloatTree, HalfTree, DoubleTree, Int32Tree, Int64Tree, BoolTree, MaskTree,
                         Vec3STree, Vec3DTree, Vec3ITree>(stored, repair, source))
            throw std::runtime_error("no reader for values of " + stored.treeType);
    } catch (const std::bad_alloc&) {
        throw failure("out of memory while reading {}", listed.path.string());
    } catch (const std::exception& e) {
        throw inputError("{} is damaged: grid '{}': {}{}", listed.path.string(), grid.uniqueName,
                         e.what(), file.wayOut());
    }
    return source;
}

VdbPeer readByOpenVdb(const std::filesystem::path& file, const std::string& grid) {
    try {
        openvdb::initialize();
        openvdb::io::File in(file.string());
        in.open(/*delayLoad=*/false);
        const openvdb::GridBase::Ptr read = in.readGrid(grid);
        return {read->activeVoxelCount(), read->memUsage()};
    } catch (const openvdb::Exception& e) {
        throw inputError("{}: OpenVDB cannot read grid '{}': {}", file.string(), grid, e.what());
    }
}

}  // namespace woodcock::grid
