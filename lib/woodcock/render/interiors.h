// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
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

    /// Whatever a camera ray starts on, and is inside of whichever way it goes.
    struct Start {
        Vec3d position;
        InteriorStack inside;
        std::vector<CoincidentSurface> touched;
    };
    Start around(Vec3d position) const;
    /// Where a ray starts there: on a surface, it is where it is going.
    Place place(const Start& start, Vec3d direction) const;

    /// Index of the medium that fills the place: 0 is outside, others are interiors[index - 1].
    std::uint32_t medium(const InteriorStack& inside) const;
    Crossing cross(const InteriorStack& inside, Vec3d direction, const SurfaceHit& hit) const;

    const SurfaceObject& object(const SurfaceHit& hit) const { return set_.objects[hit.object]; }
    /// The hit's triangle in the scene's MeshLight, or SurfaceObject::dark.
    std::uint32_t emitter(const SurfaceHit& hit) const {
        const std::uint32_t first = set_.firstEmitter[hit.instance];
        return first == SurfaceObject::dark ? first : first + hit.primitive;
    }
    /// Whether this emitter is the hit's triangle, or lies in the same place.
    bool startsOn(const SurfaceHit& hit, std::uint32_t emitter) const;
    /// The nearest hit; camera rays go through what is invisible to them. Of surfaces in one place,
    /// the next layer: see interiors_together.cpp.
    bool nearest(Vec3d origin, Vec3d direction, double tMax, const Place& start, bool cameraRay,
                 SurfaceHit& hit) const;

private:
    static constexpr std::uint32_t outside = 0xffffffffu;

    /// Surfaces in one place, from the side that the hit's own normal points to on. What light may
    /// be inside of ends before what it cannot enter; all such are one boundary.
    enum Layer : std::uint8_t {
        NoLayer,      ///< comes from elsewhere
        Front,        ///< interiors on this side
        FrontSheet,   ///< with holes
        Solid,        ///< ends the light's way
        BackSheet,    ///< the sheet again, for light from the other side
        Back,         ///< interiors on the other side
        OneBoundary,  ///< all interiors, where nothing stands between them
        FromCamera    ///< none: the place of a camera
    };
    /// What decides among surfaces in one place, the larger counts.
    using Rank = std::tuple<int, int, std::uint32_t, std::uint32_t, std::uint32_t>;
    Rank rank(const CoincidentSurface& surface, double side) const;
    bool inLayer(const CoincidentSurface& surface, const SurfaceHit& hit) const;
    /// The first layer beyond `hit`, which may be one itself, in a direction; false: there is none.
    bool nextLayer(const SurfaceHit& hit, Vec3d direction, const InteriorStack& inside,
                   bool cameraRay, SurfaceHit& next) const;
    /// What crossing all interiors of a layer leaves and enters.
    void crossLayer(const SurfaceHit& hit, std::span<const CoincidentSurface> surfaces,
                    Vec3d direction, InteriorStack& near, InteriorStack& beyond) const;

    /// The instance that fills the place, or `outside`.
    std::uint32_t filling(const InteriorStack& inside) const;
    double ior(std::uint32_t instance) const;
    const SurfaceObject& objectOf(std::uint32_t instance) const {
        return set_.objects[set_.geometry.instances()[instance].object];
    }

    const SurfaceSet& set_;
    std::vector<bool> holds_;  ///< by object: light gets inside
    /// By object: it sends light out of its front (1), of both sides (2), or of none.
    std::vector<std::uint8_t> shines_;
    std::vector<bool> sheet_;  ///< by object: it holds nothing, and has holes
    bool anyHolds_ = false;
    bool anyInvisible_ = false;
};

}  // namespace woodcock
