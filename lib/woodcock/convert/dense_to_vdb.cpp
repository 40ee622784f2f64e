// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/dense_to_vdb.h"

#include <openvdb/tools/Prune.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "woodcock/base/error.h"
#include "woodcock/convert/openvdb_each_type.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_transform.h"

namespace woodcock::convert {

namespace {

constexpr std::int64_t leafSide = 8;

template <class TreeT>
class TreeFromDense {
public:
    using Leaf = typename TreeT::LeafNodeType;
    using Value = typename TreeT::ValueType;
    using Number = typename VoxelTraits<Value>::Number;
    static constexpr int channels = VoxelTraits<Value>::channels;

    TreeFromDense(const DenseVolume& volume, const ValueOptions& options)
        : volume_(volume), options_(options) {
        for (std::size_t a = 0; a < 3; ++a) leaves_[a] = (volume.dims[a] + leafSide - 1) / leafSide;
    }

    typename TreeT::Ptr make(ValueSummary& summary, const WorkProgress& progress) {
        const auto count = static_cast<std::size_t>(leaves_[0] * leaves_[1] * leaves_[2]);
        std::vector<std::unique_ptr<Leaf>> made(count);
        WorkCounter counter(progress, count);
        summary = tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, count, 64), ValueSummary{},
            [&](const tbb::blocked_range<std::size_t>& range, ValueSummary found) {
                for (std::size_t i = range.begin(); i != range.end(); ++i)
                    made[i] = makeLeaf(static_cast<std::int64_t>(i), found);
                counter.add(range.size());
                return found;
            },
            [](ValueSummary a, const ValueSummary& b) {
                a.add(b);
                return a;
            });
        auto tree = std::make_shared<TreeT>(openvdb::zeroVal<Value>());
        openvdb::tree::ValueAccessor<TreeT> access(*tree);
        for (std::unique_ptr<Leaf>& leaf : made)
            if (leaf) access.addLeaf(leaf.release());
        openvdb::tools::prune(*tree);
        return tree;
    }

private:
    /// Nothing where the leaf has no active voxels.
    std::unique_ptr<Leaf> makeLeaf(std::int64_t i, ValueSummary& summary) const {
        const Dims begin{i % leaves_[0] * leafSide, i / leaves_[0] % leaves_[1] * leafSide,
                         i / leaves_[0] / leaves_[1] * leafSide};
        Dims size;
        for (std::size_t a = 0; a < 3; ++a)
            size[a] = std::min(leafSide, volume_.dims[a] - begin[a]);
        std::array<Number, 512 * channels> values;
        readBlock(volume_, begin, size, values.data());

        const openvdb::Coord origin(static_cast<int>(begin[0]), static_cast<int>(begin[1]),
                                    static_cast<int>(begin[2]));
        std::unique_ptr<Leaf> leaf;
        Number* voxel = values.data();
        for (int x = 0; x < size[0]; ++x)
            for (int y = 0; y < size[1]; ++y)
                for (int z = 0; z < size[2]; ++z, voxel += channels) {
                    if (!remapVoxel(voxel, channels,
                                    {origin.x() + x, origin.y() + y, origin.z() + z}, options_,
                                    summary))
                        continue;
                    if (!leaf)
                        leaf = std::make_unique<Leaf>(origin, openvdb::zeroVal<Value>(), false);
                    const auto n = static_cast<openvdb::Index>(x << 6 | y << 3 | z);
                    if constexpr (channels == 1)
                        leaf->setValueOn(n, *voxel);
                    else
                        leaf->setValueOn(n, Value(voxel));
                }
        return leaf;
    }

    const DenseVolume& volume_;
    const ValueOptions& options_;
    Dims leaves_{};
};

template <class TreeT>
openvdb::GridBase::Ptr makeGrid(const DenseVolume& volume, const ValueOptions& options,
                                ValueSummary& summary, const WorkProgress& progress) {
    return openvdb::Grid<TreeT>::create(
        TreeFromDense<TreeT>(volume, options).make(summary, progress));
}

}  // namespace

grid::VdbGrids denseToVdb(const DenseVolume& volume, const ValueOptions& options,
                          ValueSummary& summary, const WorkProgress& progress) {
    if (volume.channels != 1 && volume.channels != 3)
        throw inputError(
            "'{}' has {} channels, and a grid has 1 or 3; choose one by --channel, 0 to {}",
            volume.name, volume.channels, volume.channels - 1);
    openvdb::initialize();
    const auto make = [&]<class ScalarTree, class VectorTree>(ScalarTree*, VectorTree*) {
        return volume.channels == 1 ? makeGrid<ScalarTree>(volume, options, summary, progress)
                                    : makeGrid<VectorTree>(volume, options, summary, progress);
    };
    using namespace openvdb;
    const GridBase::Ptr grid =
        fitsFloat(volume.type)
            ? make(static_cast<FloatTree*>(nullptr), static_cast<Vec3STree*>(nullptr))
            : make(static_cast<DoubleTree*>(nullptr), static_cast<Vec3DTree*>(nullptr));
    grid->setName(volume.name);
    grid->setGridClass(GRID_FOG_VOLUME);
    grid->setTransform(grid::openVdbTransform(volume.worldFromIndex));
    return {{grid}};
}

}  // namespace woodcock::convert
