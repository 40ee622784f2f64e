// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/mesh/surface_mesh.h"

namespace woodcock {

/// Shapes in object space, all facing outwards. A plane is infinite, y = 0, and faces +y: what is
/// below is inside. A disk of radius 1 lies in it, and encloses nothing.
struct UnitSphere {};
struct UnitDisk {};
struct InfinitePlane {};
using Shape = std::variant<UnitSphere, UnitDisk, InfinitePlane, std::shared_ptr<const SurfaceMesh>>;

/// A shape somewhere. A transform of negative determinant turns nothing inside out.
struct ShapeInstance {
    std::uint32_t shape = 0;
    std::uint32_t object = 0;  ///< whatever it means to the caller; comes back with hits
    Affine3d worldFromObject;
};

/// Where a ray meets a surface. All vectors are of unit length and in world space.
struct SurfaceHit {
    double t = 0;  ///< along the ray
    /// The point on the surface; of triangles a little within their edges, by what floats cannot
    /// tell (5e-7 of the mesh's size), so that paths go on from a place that is surely theirs.
    Vec3d position;
    Vec3d normal;         ///< the surface's own, outwards
    Vec3d shadingNormal;  ///< interpolated, on the same side; the same where there is none
    /// Texture coordinates. Sphere: longitude, latitude from below; plane: x, -z; disk: the square
    /// around it.
    double u = 0, v = 0;
    std::uint32_t object = 0, instance = 0, primitive = 0;
    /// What lies in the same place. Geometry sets the first two; the rest is kept for the caller.
    struct Together {
        /// How far rounding may have put the point off its own surface: of floats in meshes, of
        /// doubles in transforms. In world units.
        double reach = 0;
        bool any = false;  ///< other surfaces may lie there: see Geometry::coincidentSurfaces()
        std::uint8_t layer = 0;  ///< which of them this is
        bool turned = false;     ///< its normal is the opposite one of what was hit
        bool forCamera = false;  ///< as the camera sees them
    } coincident = {};
};

/// A surface that passes through the place of a hit.
struct CoincidentSurface {
    std::uint32_t instance = 0, object = 0, primitive = 0;
    double facing = 0;  ///< which way its normal points: cosine to the normal of the hit
    Vec3d normal;       ///< its own, outwards, unit
};

/// All surfaces of a scene. What a ray may meet is found by Embree in floats, in each shape's own
/// frame, and then decided on and worked out in doubles. Immutable; shared by threads.
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

    /// The nearest hit with 0 < t < tMax. `left`: the hit at whose position the ray starts, null in
    /// free space; a ray does not meet again the place that it leaves, nor what lies together with
    /// it. No closed mesh has cracks, but a ray that is aimed at one of its corners to the last bit
    /// of a float may pass there.
    bool intersect(Vec3d origin, Vec3d direction, double tMax, const SurfaceHit* left,
                   SurfaceHit& hit) const;

    /// All surfaces in the place of a hit of which `together.any` says that there may be several,
    /// in the order of instances and primitives: those that pass through its position and have its
    /// normal or the opposite one, as far as rounding can tell. With a normal of length zero, all
    /// that pass through the position, whichever way they face.
    void coincidentSurfaces(const SurfaceHit& hit, std::vector<CoincidentSurface>& found) const;
    /// One of them in the hit's stead: what it says of itself, at the hit's position.
    SurfaceHit inPlaceOf(const SurfaceHit& hit, const CoincidentSurface& other) const;

    /// The instances that enclose a point, in order; only of those for which `closed` (by object)
    /// is true. Counts what a ray from the point leaves and enters.
    std::vector<std::uint32_t> enclosing(Vec3d point, const std::vector<bool>& closed) const;

    /// World box of all finite shapes; empty where there are none.
    Box3d bounds() const;
    std::size_t memoryBytes() const;  ///< of Embree's own structures and ours

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace woodcock
