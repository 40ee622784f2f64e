// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/convert/dense_to_vdb.h"
#include "woodcock/convert/openvdb_each_type.h"
#include "woodcock/grid/half.h"
#include "woodcock/grid/vdb/openvdb_exact_copy.h"
#include "woodcock/grid/vdb/openvdb_grids.h"

namespace woodcock::convert {

namespace {

Vec3i toVec(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

template <class Value>
typename VoxelTraits<Value>::Number* numbers(Value& value) {
    if constexpr (VoxelTraits<Value>::channels == 1)
        return &value;
    else
        return value.asPointer();
}

/// Calls `visit(iterator, result)` for the active values of leaves, in parallel, then of tiles;
/// iterators of a const tree where it is one.
template <class TreeT, class Result, class Visit>
Result overActiveValues(TreeT& tree, Visit visit) {
    openvdb::tree::LeafManager<TreeT> leaves(tree);
    Result result = tbb::parallel_reduce(
        leaves.leafRange(16), Result{},
        [&](const auto& range, Result part) {
            for (auto leaf = range.begin(); leaf; ++leaf)
                for (auto it = leaf->beginValueOn(); it; ++it) visit(it, part);
            return part;
        },
        [](Result a, const Result& b) {
            a.add(b);
            return a;
        });
    auto tile = tree.beginValueOn();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) visit(tile, result);
    return result;
}

template <class GridT>
void remapGrid(GridT& grid, const ValueOptions& options, ValueSummary& summary) {
    using Value = typename GridT::ValueType;
    const bool offWhereZero = grid.background() == openvdb::zeroVal<Value>();
    summary.add(overActiveValues<typename GridT::TreeType, ValueSummary>(
        grid.tree(), [&](auto& it, ValueSummary& part) {
            Value value = *it;
            const bool visible = remapVoxel(numbers(value), VoxelTraits<Value>::channels,
                                            toVec(it.getCoord()), options, part);
            it.setValue(value);
            if (!visible && offWhereZero) it.setValueOff();
        }));
    openvdb::tools::prune(grid.tree());
}

struct Loss {
    PrecisionLoss most;
    grid::VoxelCount beyond;

    void add(const Loss& more) {
        most.absolute = std::max(most.absolute, more.most.absolute);
        most.relative = std::max(most.relative, more.most.relative);
        beyond.add(more.beyond);
    }
    void add(double exact, double rounded) {
        const double error = std::abs(rounded - exact);
        most.absolute = std::max(most.absolute, error);
        if (error > 0) most.relative = std::max(most.relative, error / std::abs(exact));
    }
};

template <class GridT>
Loss measureLoss(const GridT& grid, Precision precision) {
    using Value = typename GridT::ValueType;
    return overActiveValues<const typename GridT::TreeType, Loss>(
        grid.tree(), [&](const auto& it, Loss& loss) {
            Value value = *it;
            for (int c = 0; c < VoxelTraits<Value>::channels; ++c) {
                const auto exact = static_cast<double>(numbers(value)[c]);
                const auto asFloat = static_cast<float>(exact);
                const bool asHalf = precision == Precision::Half;
                // From here on a half would be rounded to infinity.
                const bool fits = asHalf ? std::abs(asFloat) < 65520.0f : std::isfinite(asFloat);
                if (!fits)
                    loss.beyond.add(toVec(it.getCoord()));
                else
                    loss.add(exact,
                             static_cast<double>(
                                 asHalf ? grid::decodeHalf(grid::encodeHalf(asFloat)) : asFloat));
            }
        });
}

template <class To, class From>
To toValue(const From& value) {
    if constexpr (openvdb::VecTraits<To>::IsVec) {
        using Number = typename openvdb::VecTraits<To>::ElementType;
        return To(static_cast<Number>(value[0]), static_cast<Number>(value[1]),
                  static_cast<Number>(value[2]));
    } else {
        return static_cast<To>(value);
    }
}

/// The same tree of another type of values. OpenVDB's own way does not know all pairs of types:
/// vec3d to vec3s, and vec3i to anything.
template <class NewTree, class TreeT>
typename NewTree::Ptr convertedTree(const TreeT& tree) {
    using New = typename NewTree::ValueType;
    auto made =
        std::make_shared<NewTree>(tree, toValue<New>(tree.background()), openvdb::TopologyCopy());
    openvdb::tree::LeafManager<NewTree> leaves(*made);
    leaves.foreach ([&](typename NewTree::LeafNodeType& leaf, std::size_t) {
        const auto* const source = tree.probeConstLeaf(leaf.origin());
        for (openvdb::Index n = 0; n < NewTree::LeafNodeType::SIZE; ++n)
            leaf.setValueOnly(n, toValue<New>(source->getValue(n)));
    });
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        if (*tile != tree.background())
            made->addTile(tile.getLevel(), tile.getCoord(), toValue<New>(*tile), tile.isValueOn());
    return made;
}

template <class From, class To>
bool convertIf(openvdb::GridBase::Ptr& grid) {
    if (!grid->isType<From>()) return false;
    const auto& source = static_cast<const From&>(*grid);
    const auto made = To::create(convertedTree<typename To::TreeType>(source.constTree()));
    made->insertMeta(static_cast<const openvdb::MetaMap&>(source));
    made->setTransform(grid::exactCopy(source.transform()));
    grid = made;
    return true;
}

/// The largest difference between an integer and its double.
double lossOfInt64(const openvdb::GridBase& grid) {
    if (!grid.isType<openvdb::Int64Grid>()) return 0;
    struct Change {
        double most = 0;
        void add(const Change& more) { most = std::max(most, more.most); }
    };
    const auto& tree = static_cast<const openvdb::Int64Grid&>(grid).constTree();
    return overActiveValues<const openvdb::Int64Tree, Change>(
               tree,
               [](const auto& it, Change& loss) {
                   // Magnitudes, as the largest may be rounded to 2^63, beyond std::int64_t.
                   const auto exact = *it < 0 ? 0 - static_cast<std::uint64_t>(*it)
                                              : static_cast<std::uint64_t>(*it);
                   const auto rounded =
                       static_cast<std::uint64_t>(std::abs(static_cast<double>(*it)));
                   const std::uint64_t error = rounded > exact ? rounded - exact : exact - rounded;
                   loss.most = std::max(loss.most, static_cast<double>(error));
               })
        .most;
}

/// A mask's values are its active states.
bool convertMask(openvdb::GridBase::Ptr& grid) {
    if (!grid->isType<openvdb::MaskGrid>()) return false;
    const auto& mask = static_cast<const openvdb::MaskGrid&>(*grid);
    auto made = openvdb::FloatGrid::create(std::make_shared<openvdb::FloatTree>(
        mask.constTree(), 0.0f, 1.0f, openvdb::TopologyCopy()));
    made->insertMeta(static_cast<const openvdb::MetaMap&>(mask));
    made->setTransform(grid::exactCopy(mask.transform()));
    grid = made;
    return true;
}

}  // namespace

void remapGrids(grid::VdbGrids& grids, const ValueOptions& options, ValueSummary& summary) {
    for (const openvdb::GridBase::Ptr& grid : grids.grids)
        withFloatingGrid(*grid, [&](auto& typed) { remapGrid(typed, options, summary); });
}

double useFloatingPoint(grid::VdbGrids& grids) {
    using namespace openvdb;
    double loss = 0;
    for (GridBase::Ptr& grid : grids.grids) {
        loss = std::max(loss, lossOfInt64(*grid));
        convertIf<Int32Grid, DoubleGrid>(grid) || convertIf<Int64Grid, DoubleGrid>(grid) ||
            convertIf<BoolGrid, FloatGrid>(grid) || convertMask(grid) ||
            convertIf<Vec3IGrid, Vec3DGrid>(grid);
    }
    return loss;
}

PrecisionLoss setPrecision(grid::VdbGrids& grids, Precision precision) {
    using namespace openvdb;
    PrecisionLoss most;
    if (precision == Precision::Source) return most;
    for (GridBase::Ptr& grid : grids.grids) {
        if (precision == Precision::Double) {
            convertIf<FloatGrid, DoubleGrid>(grid) || convertIf<Vec3SGrid, Vec3DGrid>(grid);
            continue;
        }
        Loss loss;
        withFloatingGrid(*grid, [&](const auto& typed) { loss = measureLoss(typed, precision); });
        if (loss.beyond.count > 0)
            throw inputError(
                "grid '{}': {} value{} beyond the range of a {} (first at [{}, {}, {}]); use "
                "--scale, --clamp or another --precision",
                grid->getName(), loss.beyond.count, loss.beyond.count == 1 ? " lies" : "s lie",
                precision == Precision::Half ? "half, 65504" : "float", loss.beyond.first.x,
                loss.beyond.first.y, loss.beyond.first.z);
        most.absolute = std::max(most.absolute, loss.most.absolute);
        most.relative = std::max(most.relative, loss.most.relative);
        convertIf<DoubleGrid, FloatGrid>(grid) || convertIf<Vec3DGrid, Vec3SGrid>(grid);
    }
    return most;
}

}  // namespace woodcock::convert
