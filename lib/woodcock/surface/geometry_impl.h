// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "woodcock/surface/embree_tree.h"
#include "woodcock/surface/geometry.h"
#include "woodcock/surface/geometry_mesh.h"
#include "woodcock/surface/geometry_solve.h"

// Each instance is a box of one tree, so that a million of them need little memory. Hits on an
// instance are found in the frame of its shape, so no digits are lost, wherever it is in the world
// and however small it is beside others.

namespace woodcock::surface {

/// A shape in its own frame.
struct PreparedShape {
    enum class Kind { Sphere, Disk, Plane, Mesh } kind = Kind::Mesh;
    std::optional<FramedMesh> mesh;  ///< of meshes that have triangles
    Frame frame;
    Box3d box;  ///< in its frame; empty where there is nothing of finite size
};

using Columns = std::array<Vec3d, 3>;
inline Vec3d times(const Columns& m, Vec3d v) { return m[0] * v.x + m[1] * v.y + m[2] * v.z; }
inline Vec3d timesTransposed(const Columns& m, Vec3d v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

inline double largest(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Of the tree, where instances move.
inline constexpr std::uint32_t timeSteps = 17;

struct NearestSurface {
    bool found = false;
    double t = 0;             ///< of the nearest so far
    double slack = 0;         ///< the possible rounding error of t
    bool coincident = false;  ///< another surface was met within that error
    std::uint32_t instance = 0;
    MeshPoint point;  ///< of meshes
};

/// Where an instance is, as rays need it: what one hit reads lies together.
struct InstancePlace {
    Columns localOfWorld;  ///< directions to its shape's frame
    Vec3d centre;          ///< of that frame, in the world
    double stretch;        ///< the sum of the columns' largest parts

    Vec3d localPoint(Vec3d world) const { return times(localOfWorld, world - centre); }
    LocalRay localRay(const LocalRay& world) const {
        return {localPoint(world.origin), times(localOfWorld, world.direction)};
    }
    /// Normals are covectors, so the outside does not depend on the sign of the determinant.
    Vec3d gradient(Vec3d localNormal) const { return timesTransposed(localOfWorld, localNormal); }
    Vec3d worldNormal(Vec3d localNormal) const { return normalize(gradient(localNormal)); }
};

struct Geometry::Impl {
    /// Where an instance is at a time. One that stands still is read from where it is kept.
    class Placement {
    public:
        Placement(const Affine3d& worldFromObject, const InstancePlace& place)
            : worldFromObject_(&worldFromObject), place_(&place) {}
        Placement(const Impl& geometry, std::uint32_t instance, float time);
        Placement(const Placement&) = delete;
        Placement& operator=(const Placement&) = delete;

        const Affine3d& worldFromObject() const { return *worldFromObject_; }
        const InstancePlace& operator*() const { return *place_; }
        const InstancePlace* operator->() const { return place_; }

    private:
        struct Moved {
            Affine3d worldFromObject;
            InstancePlace place;
        };
        const Affine3d* worldFromObject_;
        const InstancePlace* place_;
        std::optional<Moved> moved_;
    };

    std::vector<Shape> shapes;
    std::vector<ShapeInstance> instances;
    std::optional<EmbreeDevice> device;   ///< only where something is of finite size
    std::vector<PreparedShape> prepared;  ///< of each shape
    std::vector<InstancePlace> places;    ///< of each instance, at rest
    std::vector<std::uint32_t> finite, planes;
    bool moves = false;
    Box3d bounds;
    Frame frame;  ///< of the tree
    EmbreeTree tree;

    Impl(std::vector<Shape> s, std::vector<ShapeInstance> i);
    void prepareShape(const Shape& shape);
    void placeInstance(std::uint32_t i);
    InstancePlace placeAt(std::uint32_t i, const Affine3d& worldFromObject) const;
    void buildTree();
    Box3d worldBox(std::uint32_t i) const;  ///< of the whole shutter
    Box3d boxAt(std::uint32_t i, const Affine3d& worldFromObject) const;
    std::vector<Box3d> boxesAtSteps(std::uint32_t i) const;

    const PreparedShape& shapeOf(std::uint32_t i) const { return prepared[instances[i].shape]; }
    Placement placed(std::uint32_t i, float time) const { return {*this, i, time}; }
    /// Of an instance that moves.
    Affine3d worldFromObjectAt(std::uint32_t i, float time) const;
    Vec3d world(std::uint32_t i, const Placement& at, Vec3d p) const {
        return at.worldFromObject().vector(p * (1 / shapeOf(i).frame.scale)) + at->centre;
    }

    struct NearestVisitor;
    struct EnclosingVisitor;
    template <class Visitor>
    void visitInstances(const LocalRay& ray, float time, Visitor& visitor) const;
    void meet(std::uint32_t i, const LocalRay& worldRay, float time, const SurfaceHit* left,
              NearestSurface& nearest) const;
    std::optional<MeshPoint> meetMesh(std::uint32_t i, const LocalRay& ray, double tMax,
                                      const SurfaceHit* left) const;
    bool encloses(std::uint32_t i, Vec3d point, float time) const;
    void complete(const NearestSurface& nearest, const LocalRay& worldRay, float time,
                  SurfaceHit& hit) const;
    void completeMesh(const Placement& at, const Triangle& triangle,
                      const std::array<double, 3>& weights, SurfaceHit& hit) const;
    void completeShape(const Placement& at, Vec3d p, SurfaceHit& hit) const;

    // ---- surfaces that coincide: geometry_coincident.cpp

    /// How far rounding may move a point off the plane of an instance's surface: the rounding of
    /// the numbers from which the point and the plane are computed. `ofPlane`: that of a mesh's
    /// corners, along the normal.
    static double reach(const InstancePlace& at, Vec3d normal, Vec3d point, double ofPlane);
    double reach(std::uint32_t i, const InstancePlace& at, const SurfaceHit& hit) const;
    /// The error of t that follows from it, at a hit at `t` along a ray.
    double slackOf(std::uint32_t i, const InstancePlace& at, const LocalRay& worldRay,
                   const LocalRay& ray, double t, const MeshPoint& point) const;
    struct LocalHit;
    /// The surface, if it passes through the position of a hit: an instance's, or a triangle of its
    /// mesh.
    std::optional<CoincidentSurface> passesThrough(const LocalHit& hit) const;
    std::optional<CoincidentSurface> passesThrough(const LocalHit& hit, std::uint32_t primitive,
                                                   const Triangle& triangle) const;
};

/// A hit as the surfaces of an instance see it.
struct Geometry::Impl::LocalHit {
    const SurfaceHit& hit;
    std::uint32_t instance;
    Placement at;
    Vec3d position;  ///< in the shape's frame
    double edges;    ///< so far beyond a triangle's edge still counts as on it, in the frame

    LocalHit(const Impl& geometry, const SurfaceHit& h, std::uint32_t i);
    /// The surface in the plane of unit normal `n` that `position` is `height` above, if rounding
    /// may have done that; `rounding` of the plane, along n.
    std::optional<CoincidentSurface> inPlane(std::uint32_t object, std::uint32_t primitive, Vec3d n,
                                             double height, double rounding) const;
};

inline Geometry::Impl::Placement::Placement(const Impl& geometry, std::uint32_t instance,
                                            float time)
    : Placement(geometry.instances[instance].worldFromObject, geometry.places[instance]) {
    if (!geometry.instances[instance].motion) [[likely]]
        return;
    const Affine3d there = geometry.worldFromObjectAt(instance, time);
    const Moved& m = moved_.emplace(Moved{there, geometry.placeAt(instance, there)});
    worldFromObject_ = &m.worldFromObject, place_ = &m.place;
}

}  // namespace woodcock::surface
