// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "woodcock/convert/dense_to_vdb.h"
#include "woodcock/convert/openvdb_each_type.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/half.h"
#include "woodcock/grid/openvdb_grids.h"

namespace woodcock {

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
    VoxelCount beyond;

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
    return overActiveValues<const typename GridT::TreeType, Loss>(grid.tree(), [&](const auto& it,
                                                                                   Loss& loss) {
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
                         static_cast<double>(asHalf ? decodeHalf(encodeHalf(asFloat)) : asFloat));
        }
    });
}

template <class NewGrid, class GridT>
openvdb::GridBase::Ptr converted(const GridT& grid) {
    auto made = NewGrid::create(
        typename NewGrid::TreePtrType(new typename NewGrid::TreeType(grid.constTree())));
    made->insertMeta(static_cast<const openvdb::MetaMap&>(grid));
    made->setTransform(grid.transform().copy());
    return made;
}

template <class From, class To>
bool convertIf(openvdb::GridBase::Ptr& grid) {
    if (!grid->isType<From>()) return false;
    grid = converted<To>(static_cast<const From&>(*grid));
    return true;
}

/// A mask has no values but whether it is active.
bool convertMask(openvdb::GridBase::Ptr& grid) {
    if (!grid->isType<openvdb::MaskGrid>()) return false;
    const auto& mask = static_cast<const openvdb::MaskGrid&>(*grid);
    auto made = openvdb::FloatGrid::create(std::make_shared<openvdb::FloatTree>(
        mask.constTree(), 0.0f, 1.0f, openvdb::TopologyCopy()));
    made->insertMeta(static_cast<const openvdb::MetaMap&>(mask));
    made->setTransform(mask.transform().copy());
    grid = made;
    return true;
}

}  // namespace

void remapGrids(VdbGrids& grids, const ValueOptions& options, ValueSummary& summary) {
    for (const openvdb::GridBase::Ptr& grid : grids.grids)
        withFloatingGrid(*grid, [&](auto& typed) { remapGrid(typed, options, summary); });
}

void useFloatingPoint(VdbGrids& grids) {
    using namespace openvdb;
    for (GridBase::Ptr& grid : grids.grids)
        convertIf<Int32Grid, DoubleGrid>(grid) || convertIf<Int64Grid, DoubleGrid>(grid) ||
            convertIf<BoolGrid, FloatGrid>(grid) || convertMask(grid) ||
            convertIf<Vec3IGrid, Vec3DGrid>(grid);
}

PrecisionLoss setPrecision(VdbGrids& grids, Precision precision) {
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

}  // namespace woodcock
