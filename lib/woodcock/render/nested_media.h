// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "woodcock/render/scene.h"
#include "woodcock/surface/bsdf.h"

namespace woodcock::render {

/// The closed surfaces that a path is inside of, by instance. The one of highest priority decides
/// which medium is there: Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images".
class MediumStack {
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
    MediumStack near;    ///< what the ray is inside of before the surface
    MediumStack beyond;  ///< and behind it
    surface::Bsdf bsdf;
    /// Light goes on unchanged: an interface, equal indices of refraction, or a surface within
    /// another one of higher priority.
    bool passes;
};

/// A ray that looks for surfaces: world space, direction of unit length.
struct SurfaceQuery {
    Vec3d origin, direction;
    float time = 0;  ///< within the shutter
    double tMax = std::numeric_limits<double>::infinity();
    bool cameraRay = false;  ///< goes through what is invisible to the camera
};

/// The surfaces of a scene, and the media inside of them. Where closed surfaces overlap, their
/// priorities say which medium a place has.
class NestedMedia {
public:
    /// `scene` must have surfaces, and outlive this.
    explicit NestedMedia(const Scene& scene);

    /// Where a ray starts.
    struct RayStart {
        MediumStack inside = {};
        std::optional<surface::SurfaceHit> left = {};  ///< the surface that it starts on
    };

    /// A point from which camera rays start: what encloses it, and which surfaces it lies on.
    struct CameraPosition {
        Vec3d position;
        MediumStack inside;
        std::vector<surface::CoincidentSurface> touched;
        float time = 0;  ///< within the shutter
    };
    CameraPosition cameraPosition(Vec3d position, float time) const;
    /// The start of a ray from there. A ray that starts on a surface is inside of it if it goes
    /// inwards.
    RayStart rayStart(const CameraPosition& start, Vec3d direction) const;

    /// Index of the medium that counts: 0 is the scene's own, others are
    /// Scene::interiorMedia[index - 1].
    std::uint32_t medium(const MediumStack& inside) const;
    Crossing cross(const MediumStack& inside, Vec3d direction,
                   const surface::SurfaceHit& hit) const;

    const surface::SurfaceObject& object(const surface::SurfaceHit& hit) const {
        return set_.objects[hit.object];
    }
    /// Surely no light gets through: cross() need not be asked.
    bool opaque(const surface::SurfaceHit& hit) const { return opaque_[hit.object]; }
    /// The hit's triangle in the scene's MeshLight, or SurfaceObject::dark.
    std::uint32_t emitter(const surface::SurfaceHit& hit) const {
        const std::uint32_t first = set_.firstEmitter[hit.instance];
        return first == surface::SurfaceObject::dark ? first : first + hit.primitive;
    }
    /// Whether this emitter is the hit's triangle, or lies in the same place.
    bool startsOn(const surface::SurfaceHit& hit, std::uint32_t emitter) const;
    /// The nearest hit before ray.tMax; false: none. Where surfaces coincide it is the next layer
    /// of them: see coincident_surfaces.cpp.
    bool nearest(const SurfaceQuery& ray, const RayStart& start, surface::SurfaceHit& hit) const;

private:
    static constexpr std::uint32_t outside = 0xffffffffu;

    /// The layers of surfaces that coincide, beginning at the side to which the hit's own normal
    /// points. Closed surfaces that light can enter end before those that it cannot enter. All
    /// that it can enter are one boundary.
    enum Layer : std::uint8_t {
        NoLayer,      ///< the ray comes from elsewhere
        Front,        ///< closed surfaces on this side
        FrontSheet,   ///< an opaque surface with holes
        Solid,        ///< an opaque surface
        BackSheet,    ///< the sheet again, for light from the other side
        Back,         ///< closed surfaces on the other side
        OneBoundary,  ///< all closed surfaces, where nothing opaque lies between them
        FromCamera    ///< none: the ray starts at a camera
    };
    /// What decides among surfaces that coincide: the larger rank counts.
    using Rank = std::tuple<int, int, std::uint32_t, std::uint32_t, std::uint32_t>;
    Rank rank(const surface::CoincidentSurface& surface, double side) const;
    bool inLayer(const surface::CoincidentSurface& surface, const surface::SurfaceHit& hit) const;
    struct Place;
    Place placeOf(const surface::SurfaceHit& hit,
                  std::span<const surface::CoincidentSurface> surfaces, bool cameraRay) const;
    const surface::CoincidentSurface* boundaryThatCounts(
        const surface::SurfaceHit& layer, std::span<const surface::CoincidentSurface> surfaces,
        Vec3d direction, const MediumStack& inside) const;
    /// The first layer beyond `hit` in a direction; `hit` may be a layer itself. False: none.
    bool nextLayer(const surface::SurfaceHit& hit, Vec3d direction, const MediumStack& inside,
                   bool cameraRay, surface::SurfaceHit& next) const;
    /// Leaves and enters what a ray crosses with all closed surfaces of a layer.
    void crossLayer(const surface::SurfaceHit& hit,
                    std::span<const surface::CoincidentSurface> surfaces, Vec3d direction,
                    MediumStack& near, MediumStack& beyond) const;

    /// The instance of highest priority, or `outside`.
    std::uint32_t filling(const MediumStack& inside) const;
    double ior(std::uint32_t instance) const;
    const surface::SurfaceObject& objectOf(std::uint32_t instance) const {
        return set_.objects[set_.geometry.instances()[instance].object];
    }

    const surface::SurfaceSet& set_;
    std::vector<bool> holds_;  ///< by object: light gets inside
    /// By object: it sends light out of its front (1), of both sides (2), or of none.
    std::vector<std::uint8_t> shines_;
    std::vector<bool> sheet_;   ///< by object: it holds nothing, and has holes
    std::vector<bool> opaque_;  ///< by object
    bool anyHolds_ = false;
    bool anyInvisible_ = false;
};

}  // namespace woodcock::render
