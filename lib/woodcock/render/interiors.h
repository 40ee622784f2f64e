// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "woodcock/render/scene.h"
#include "woodcock/surface/bsdf.h"

namespace woodcock {

/// The closed surfaces that a path is inside of, by instance. The one of highest priority fills the
/// place: Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images".
class InteriorStack {
public:
    static constexpr std::size_t capacity = 14;

    bool empty() const { return count_ == 0; }
    /// Throws Error{Input} beyond `capacity`. A surface that is entered twice counts once.
    void enter(std::uint32_t instance);
    void leave(std::uint32_t instance);
    std::span<const std::uint32_t> instances() const { return {instances_.data(), count_}; }

private:
    std::array<std::uint32_t, capacity> instances_;
    std::uint32_t count_ = 0;
};

/// What a ray meets where it hits a surface.
struct Crossing {
    InteriorStack near;    ///< what it is inside of before it is through
    InteriorStack beyond;  ///< and after
    Bsdf bsdf;
    /// Light goes on unchanged: an interface, equal indices of refraction, or a surface within
    /// another one of higher priority.
    bool passes;
};

/// The surfaces of a scene and what they hold, as paths ask for them.
class Interiors {
public:
    /// `scene` must have surfaces, and outlive this.
    explicit Interiors(const Scene& scene);

    /// Where a ray starts.
    struct Place {
        InteriorStack inside = {};
        std::optional<SurfaceHit> left = {};  ///< the surface that it starts on
    };

    /// What a camera ray that starts here is inside of.
    InteriorStack at(Vec3d position) const;

    /// Index of the medium that fills the place: 0 is outside, others are interiors[index - 1].
    std::uint32_t medium(const InteriorStack& inside) const;
    Crossing cross(const InteriorStack& inside, Vec3d direction, const SurfaceHit& hit) const;

    const SurfaceObject& object(const SurfaceHit& hit) const { return set_.objects[hit.object]; }
    /// The nearest hit; camera rays go through what is invisible to them.
    bool nearest(Vec3d origin, Vec3d direction, double tMax, const Place& start, bool cameraRay,
                 SurfaceHit& hit) const;

private:
    static constexpr std::uint32_t outside = 0xffffffffu;

    /// The instance that fills the place, or `outside`.
    std::uint32_t filling(const InteriorStack& inside) const;
    double ior(std::uint32_t instance) const;
    const SurfaceObject& objectOf(std::uint32_t instance) const {
        return set_.objects[set_.geometry.instances()[instance].object];
    }

    const SurfaceSet& set_;
    std::vector<bool> holds_;  ///< by object: light gets inside
    bool anyHolds_ = false;
    bool anyInvisible_ = false;
};

}  // namespace woodcock
