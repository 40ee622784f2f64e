// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "woodcock/base/moving_transform.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/light/light_sample.h"
#include "woodcock/light/light_tree.h"

namespace woodcock::light {

/// All emissive triangles of a scene as one light: a triangle is chosen through a tree by power,
/// distance and orientation (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
/// Adaptive Tree Splitting"), then a direction into it, uniform in solid angle.
class MeshLight {
public:
    struct Triangle {
        std::array<Vec3d, 3> corner;  ///< world space; emits where it is counter-clockwise
        Rgb radiance;                 ///< mean over it, where a texture varies it
        bool bothSides = false;
        std::uint8_t group = 0;  ///< as LightSet::group()
        bool operator==(const Triangle&) const = default;
    };
    /// Radiance of a triangle where a texture varies it: at corner 0 + b1 (corner 1 - corner 0) +
    /// b2 (corner 2 - corner 0), from its front or its back.
    using RadianceAt = std::function<Rgb(std::uint32_t triangle, double b1, double b2, bool front)>;

    /// Triangles that move within the shutter: from `first` to before `end`.
    struct Moving {
        std::uint32_t first, end;
        /// From where they are at rest to where they are at a time; not null.
        std::shared_ptr<const MovingTransform> motion;
    };

    /// Triangles of zero area or radiance, or with numbers that are not finite, are never sampled.
    /// Without `radianceAt` each emits its mean everywhere. `moving` is in the triangles' order.
    explicit MeshLight(std::vector<Triangle> triangles, RadianceAt radianceAt = {},
                       std::vector<Moving> moving = {});

    std::span<const Triangle> triangles() const { return triangles_; }  ///< at rest
    bool moves() const { return !moving_.empty(); }                     ///< whether any does

    LightTraits traits() const { return {.name = "an emissive surface"}; }
    /// A sample at `from` (world), at a path's time. Its weight is 0 where no triangle can be seen;
    /// else its `emitter` is the chosen one.
    LightSample sample(Vec3d from, double u0, double u1, float time = 0) const;
    /// 0: a direction does not say which triangle it meets. The other pdf() takes that.
    double pdf(Vec3d, Vec3d) const { return 0; }
    /// Density, per steradian, with which sample() at `from` finds `position` on this triangle; 0
    /// where the triangle sends nothing to `from`.
    double pdf(Vec3d from, std::uint32_t triangle, Vec3d position, float time = 0) const;

    double importance(const ScatterPoint& at) const;
    double typicalRadiance(const Box3d& bounds) const {
        return radianceOfLocalLight(centre_, power_ / (4 * pi), bounds);
    }
    /// Roughly the irradiance (mean over channels) at a point that faces the light. 0 only where no
    /// triangle can be seen.
    double facingIrradiance(Vec3d from, float time = 0) const;
    Vec3d centre() const { return centre_; }  ///< weighted by power; at rest, as is the power
    double power() const { return power_; }   ///< of the largest channel

private:
    class Moment;
    const MovingTransform* motionOf(std::uint32_t triangle) const;
    void addPower();
    double importance(std::uint32_t node, Moment& moment) const;
    double firstShare(std::uint32_t node, Moment& moment) const;
    Rgb radianceAt(std::uint32_t index, const Triangle& triangle, Vec3d position, bool front) const;

    std::vector<Triangle> triangles_;
    RadianceAt radianceAt_;
    std::vector<Moving> moving_;
    LightTree tree_;  ///< of what moves: around all that it is while the shutter is open
    Vec3d centre_;
    double power_ = 0;
};

}  // namespace woodcock::light
