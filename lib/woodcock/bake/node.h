// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "woodcock/bake/interval.h"
#include "woodcock/base/vec.h"

namespace woodcock::grid {
struct VdbGrids;
}

namespace woodcock::bake {

/// Positions in world space, and a box around them.
struct Points {
    std::size_t count = 0;
    std::array<const double*, 3> at{};  ///< x, y and z of each
    Box3d box{};

    Vec3d operator[](std::size_t i) const { return {at[0][i], at[1][i], at[2][i]}; }
};

/// Values of an input at the points, by channel; a scalar's three channels are the same.
struct Values {
    std::array<const double*, 3> channel{};
};
using Bounds = std::array<Interval, 3>;

/// A function of space, as a part of a recipe. Its inputs are the values of other nodes at the same
/// points. Nodes are shared by threads and have no state.
class Node {
public:
    virtual ~Node() = default;

    virtual int channels() const { return 1; }  ///< 1 or 3
    /// Fills out[c][i] for each channel and point. The values at a point must not depend on the
    /// other points of a batch: so sparse evaluation equals dense evaluation.
    virtual void evaluate(const Points& points, std::span<const Values> inputs,
                          std::span<double* const> out) const = 0;
    /// Contains every value that evaluate() can give for points in the box.
    virtual Bounds bound(const Box3d& box, std::span<const Bounds> inputs) const = 0;
};

/// A node that returns another node's values at moved points. Its inputs are evaluated at its own
/// points.
class Mapping {
public:
    virtual ~Mapping() = default;
    virtual void move(const Points& points, std::span<const Values> inputs,
                      std::span<double* const> out) const = 0;
    /// Contains all points that those of the box can move to.
    virtual Box3d moveBox(const Box3d& box, std::span<const Bounds> inputs) const = 0;
};

/// A node that needs its inputs as grids before it can be evaluated: the first input where it is
/// not zero, the others at the same voxels.
class GridStage {
public:
    virtual ~GridStage() = default;
    virtual std::vector<std::string> gridNames() const = 0;  ///< of the inputs
    /// Calls `goesOn` now and then, by one thread at a time; returns null where it returns false.
    virtual std::shared_ptr<const Node> run(grid::VdbGrids& inputs,
                                            const std::function<bool()>& goesOn) const = 0;
};

/// The nodes of a recipe. Indices are those of `nodes`; an input comes before the nodes that use
/// it.
struct Graph {
    struct Entry {
        std::shared_ptr<const Node> node = nullptr;        ///< either this
        std::shared_ptr<const Mapping> mapping = nullptr;  ///< or this, of entry `mapped`
        std::shared_ptr<const GridStage> stage = nullptr;  ///< or this, which will make a node
        std::vector<int> inputs{};
        int mapped = -1;
        int channels = 1;
        std::string place{};  ///< in the recipe's file
    };
    std::vector<Entry> entries;
};

}  // namespace woodcock::bake
