// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

struct Geometry::Impl {
    /// Where an instance is at a time. One that stands still is read from where it is kept.
    class Placement {
    public:
        explicit Placement(const Affine3d& worldFromObject, const Columns* localOfWorld = nullptr)
            : worldFromObject_(&worldFromObject), localOfWorld_(localOfWorld) {}
        Placement(const Impl& geometry, std::uint32_t instance, float time);
        Placement(const Placement&) = delete;
        Placement& operator=(const Placement&) = delete;

        const Affine3d& worldFromObject() const { return *worldFromObject_; }
        /// Directions to its shape's frame.
        const Columns& localOfWorld() const { return *localOfWorld_; }

    private:
        struct Moved {
            Affine3d worldFromObject;
            Columns localOfWorld;
        };
        const Affine3d* worldFromObject_;
        const Columns* localOfWorld_;
        std::optional<Moved> moved_;
    };

    std::vector<Shape> shapes;
    std::vector<ShapeInstance> instances;
    std::optional<EmbreeDevice> device;   ///< only where something is of finite size
    std::vector<PreparedShape> prepared;  ///< of each shape
    std::vector<Columns> localOfWorld;    ///< of each instance: directions to its shape's frame
    std::vector<std::uint32_t> finite, planes;
    bool moves = false;
    Box3d bounds;
    Frame frame;  ///< of the tree
    EmbreeTree tree;

    Impl(std::vector<Shape> s, std::vector<ShapeInstance> i);
    void prepareShape(const Shape& shape);
    void placeInstance(std::uint32_t i);
    Columns localOfWorldAt(std::uint32_t i, const Affine3d& worldFromObject) const;
    void buildTree();
    Box3d worldBox(std::uint32_t i) const;  ///< of the whole shutter
    Box3d boxAt(std::uint32_t i, const Affine3d& worldFromObject) const;
    std::vector<Box3d> boxesAtSteps(std::uint32_t i) const;

    const PreparedShape& shapeOf(std::uint32_t i) const { return prepared[instances[i].shape]; }
    Placement placed(std::uint32_t i, float time) const { return {*this, i, time}; }
    /// Of an instance that moves.
    Affine3d worldFromObjectAt(std::uint32_t i, float time) const;
    Vec3d centre(std::uint32_t i, const Placement& at) const {
        return at.worldFromObject().point(shapeOf(i).frame.centre);
    }
    LocalRay local(std::uint32_t i, const Placement& at, const LocalRay& ray) const {
        return {times(at.localOfWorld(), ray.origin - centre(i, at)),
                times(at.localOfWorld(), ray.direction)};
    }
    Vec3d world(std::uint32_t i, const Placement& at, Vec3d p) const {
        return at.worldFromObject().vector(p * (1 / shapeOf(i).frame.scale)) + centre(i, at);
    }
    /// Normals are covectors, so the outside does not depend on the sign of the determinant.
    Vec3d worldNormal(const Placement& at, Vec3d n) const {
        return normalize(timesTransposed(at.localOfWorld(), n));
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
    void completeMesh(const Placement& at, const MeshPoint& point, SurfaceHit& hit) const;
    void completeShape(const Placement& at, Vec3d p, SurfaceHit& hit) const;

    // ---- surfaces that coincide: geometry_coincident.cpp

    /// How far rounding may move a point off the plane of an instance's surface: the rounding of
    /// the numbers from which the point and the plane are computed.
    double reach(std::uint32_t i, const Placement& at, std::uint32_t primitive, Vec3d normal,
                 Vec3d point) const;
    /// The error of t that follows from it, at a hit at `t` along a ray.
    double slackOf(std::uint32_t i, const Placement& at, const LocalRay& worldRay,
                   const LocalRay& ray, double t, const MeshPoint& point) const;
    /// The surface, if it passes through the position of a hit.
    std::optional<CoincidentSurface> passesThrough(const SurfaceHit& hit, std::uint32_t i,
                                                   std::uint32_t primitive) const;
};

inline Geometry::Impl::Placement::Placement(const Impl& geometry, std::uint32_t instance,
                                            float time)
    : Placement(geometry.instances[instance].worldFromObject, &geometry.localOfWorld[instance]) {
    if (!geometry.instances[instance].motion) [[likely]]
        return;
    const Affine3d there = geometry.worldFromObjectAt(instance, time);
    const Moved& m = moved_.emplace(Moved{there, geometry.localOfWorldAt(instance, there)});
    worldFromObject_ = &m.worldFromObject, localOfWorld_ = &m.localOfWorld;
}

}  // namespace woodcock::surface
