// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/moving_transform.h"
#include "woodcock/mesh/surface_mesh.h"

namespace woodcock::surface {

/// Shapes in object space, all facing outwards. A plane is infinite, y = 0, and faces +y; below it
/// is inside. A disk lies in y = 0, has radius 1, and encloses nothing.
struct UnitSphere {};
struct UnitDisk {};
struct InfinitePlane {};
using Shape =
    std::variant<UnitSphere, UnitDisk, InfinitePlane, std::shared_ptr<const mesh::SurfaceMesh>>;

/// A shape with its transform. A transform of negative determinant does not turn it inside out.
struct ShapeInstance {
    std::uint32_t shape = 0;
    std::uint32_t object = 0;  ///< of the caller's choice; returned with hits
    Affine3d worldFromObject;
    /// It moves within the shutter: where it takes a point of the world, in which worldFromObject
    /// places the shape at rest. Null: it stands still.
    std::shared_ptr<const MovingTransform> motion = {};
};

/// Where a ray meets a surface. All vectors are of unit length and in world space.
struct SurfaceHit {
    double t = 0;    ///< along the ray
    float time = 0;  ///< of the ray, within the shutter
    /// The point on the surface. On triangles it is kept a little within the edges (by 5e-7 of the
    /// mesh's size), so that paths surely go on from that triangle.
    Vec3d position;
    Vec3d normal;         ///< the surface's own, outwards
    Vec3d shadingNormal;  ///< interpolated, on the same side; the same where there is none
    /// Texture coordinates. Sphere: longitude, latitude from below; plane: x, -z; disk: the square
    /// around it.
    double u = 0, v = 0;
    std::uint32_t object = 0, instance = 0, primitive = 0;
    /// About surfaces that coincide at the hit. Geometry sets the first two members; the others are
    /// the caller's.
    struct Coincidence {
        /// How far rounding (floats in meshes, doubles in transforms) may have moved the point off
        /// its surface, in world units.
        double reach = 0;
        bool any = false;  ///< other surfaces may coincide: see Geometry::coincidentSurfaces()
        std::uint8_t layer = 0;  ///< the layer of the hit; see render/coincident_surfaces.cpp
        bool turned = false;     ///< its normal is the opposite of that of the surface that was hit
        bool forCamera = false;  ///< as the camera sees them
    } coincident = {};
};

/// A surface that passes through the position of a hit.
struct CoincidentSurface {
    std::uint32_t instance = 0, object = 0, primitive = 0;
    double facing = 0;  ///< cosine of its normal to the normal of the hit
    Vec3d normal;       ///< its own, outwards, unit
};

/// All surfaces of a scene. Embree finds candidates in floats, in each shape's own frame; hits are
/// then decided on and computed in doubles. Immutable; shared by threads. Where an instance moves,
/// rays see it as it is at their time, exactly: only the boxes around moving instances are
/// Embree's interpolation, and a little larger for it.
class Geometry {
public:
    /// Throws Error{Input} on transforms that are not finite or flatten their shape, naming the
    /// instance; Error{Failure} where Embree has no memory.
    Geometry(std::vector<Shape> shapes, std::vector<ShapeInstance> instances);
    ~Geometry();
    Geometry(Geometry&&) noexcept;
    Geometry& operator=(Geometry&&) noexcept;

    const std::vector<Shape>& shapes() const;
    const std::vector<ShapeInstance>& instances() const;

    /// The nearest hit with 0 < t < tMax, of surfaces as they are at `time` within the shutter;
    /// false: none. `left`: the hit at whose position the ray
    /// starts, null in free space. A ray does not meet again the surface that it leaves, nor
    /// surfaces that coincide with it. Closed meshes have no cracks, but a ray that is aimed
    /// exactly at a corner, to the last bit of a float, may pass there.
    bool intersect(Vec3d origin, Vec3d direction, double tMax, const SurfaceHit* left,
                   SurfaceHit& hit, float time = 0) const;

    /// All surfaces that coincide with a hit, where hit.coincident.any is true, in the order of
    /// instances and primitives. They pass through its position and have its normal or the opposite
    /// one, up to rounding. If the hit's normal has length zero, all surfaces through its position
    /// count, whichever way they face.
    void coincidentSurfaces(const SurfaceHit& hit, std::vector<CoincidentSurface>& found) const;
    /// The hit on one of these surfaces, at the position of `hit`.
    SurfaceHit inPlaceOf(const SurfaceHit& hit, const CoincidentSurface& other) const;

    /// The instances that enclose a point (world) at a time, in order; only those for which
    /// `closed` (by object) is true. It counts the surfaces that a ray from the point leaves and
    /// enters.
    std::vector<std::uint32_t> enclosing(Vec3d point, const std::vector<bool>& closed,
                                         float time = 0) const;
    bool moves() const;  ///< whether any instance does

    /// World box of all finite shapes, of the whole shutter; empty where there are none.
    Box3d bounds() const;
    std::size_t memoryBytes() const;  ///< of Embree's structures and our own

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace woodcock::surface
