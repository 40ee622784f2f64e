// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "woodcock/base/spectrum.h"
#include "woodcock/base/vec.h"

namespace woodcock {

struct LightSample;

/// All emissive triangles of a scene as one light: a triangle is chosen through a tree by power,
/// distance and orientation (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting"), then a point on it by area.
class MeshLight {
public:
    struct Triangle {
        std::array<Vec3d, 3> corner;  ///< world space; emits where it is counter-clockwise
        Rgb radiance;                 ///< mean over it, where a texture varies it
        bool bothSides = false;
        bool operator==(const Triangle&) const = default;
    };
    explicit MeshLight(std::vector<Triangle> triangles);

    std::span<const Triangle> triangles() const { return triangles_; }

    /// Weight 0 where nothing of it is seen. `triangle` becomes the chosen one.
    LightSample sample(Vec3d from, double u0, double u1, std::uint32_t& triangle) const;
    /// Per steradian: that sample() at `from` finds `position` on this triangle.
    double pdf(Vec3d from, std::uint32_t triangle, Vec3d position) const;

    /// Rough irradiance (mean over channels) at a point that faces it: steers the choice among
    /// lights.
    double promise(Vec3d from) const;
    Vec3d centre() const;  ///< of its power
    double power() const;  ///< of the largest channel

private:
    struct Node {
        Box3d box;
        Vec3d axis;
        double cosSpread = 1;  ///< of the normals around the axis; -1: all directions
        double power = 0;
        std::uint32_t second = 0;    ///< the second child; the first is the next node
        std::uint32_t triangle = 0;  ///< of a leaf
        bool leaf = false;
    };
    double importance(const Node& node, Vec3d from) const;

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
    std::vector<std::uint64_t> path_;  ///< of each triangle: which child at each level
};

}  // namespace woodcock
