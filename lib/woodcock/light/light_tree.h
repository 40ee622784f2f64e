// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::light {

/// Bounds of some emitters. Each radiates by Lambert's law around its normal.
struct EmitterBounds {
    Box3d box;
    Vec3d axis;         ///< unit
    double spread = 0;  ///< largest angle between a normal and the axis; pi: all directions
    double power = 0;   ///< radiance times area

    /// The tree's builder keeps it small.
    double cost() const;  ///< Conty Estevez and Kulla 2018, eq. 1 and 2
};
/// Bounds of both.
EmitterBounds merged(const EmitterBounds& a, const EmitterBounds& b);

/// A binary tree over emitters, by Conty Estevez and Kulla 2018, "Importance Sampling of Many
/// Lights with Adaptive Tree Splitting".
struct LightTree {
    struct Node {
        Vec3d centre;
        double radius = 0;  ///< of the sphere that holds all
        Vec3d axis;
        double cosSpread = 1;  ///< -1: all directions
        double power = 0;
        std::uint32_t second = 0;   ///< the second child, the first is the next node; 0: a leaf
        std::uint32_t emitter = 0;  ///< of a leaf

        bool leaf() const { return second == 0; }
        /// Roughly a bound of the irradiance, perpendicular to the light, that it could send to a
        /// point (world). 0 only where all of it faces away.
        double importance(Vec3d from) const;
    };
    std::vector<Node> nodes;  ///< none where there are no emitters
    /// The way to each emitter: which child to take at each level, the root's in the lowest bit.
    std::vector<std::uint64_t> paths;

    LightTree() = default;
    /// Emitters of no power are left out; their entries of `paths` are void.
    explicit LightTree(std::span<const EmitterBounds> emitters);
};

}  // namespace woodcock::light
