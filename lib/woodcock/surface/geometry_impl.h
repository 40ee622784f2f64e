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

struct NearestSurface {
    bool found = false;
    double t = 0;             ///< of the nearest so far
    double slack = 0;         ///< the possible rounding error of t
    bool coincident = false;  ///< another surface was met within that error
    std::uint32_t instance = 0;
    MeshPoint point;  ///< of meshes
};

struct Geometry::Impl {
    std::vector<Shape> shapes;
    std::vector<ShapeInstance> instances;
    std::optional<EmbreeDevice> device;   ///< only where something is of finite size
    std::vector<PreparedShape> prepared;  ///< of each shape
    std::vector<Columns> localOfWorld;    ///< of each instance: directions to its shape's frame
    std::vector<std::uint32_t> finite, planes;
    Box3d bounds;
    Frame frame;  ///< of the tree
    EmbreeTree tree;

    Impl(std::vector<Shape> s, std::vector<ShapeInstance> i);
    void prepareShape(const Shape& shape);
    void placeInstance(std::uint32_t i);
    Box3d worldBox(std::uint32_t i) const;

    const PreparedShape& shapeOf(std::uint32_t i) const { return prepared[instances[i].shape]; }
    Vec3d centre(std::uint32_t i) const {
        return instances[i].worldFromObject.point(shapeOf(i).frame.centre);
    }
    LocalRay local(std::uint32_t i, const LocalRay& ray) const {
        return {times(localOfWorld[i], ray.origin - centre(i)),
                times(localOfWorld[i], ray.direction)};
    }
    Vec3d world(std::uint32_t i, Vec3d p) const {
        return instances[i].worldFromObject.vector(p * (1 / shapeOf(i).frame.scale)) + centre(i);
    }
    /// Normals are covectors, so the outside does not depend on the sign of the determinant.
    Vec3d worldNormal(std::uint32_t i, Vec3d n) const {
        return normalize(timesTransposed(localOfWorld[i], n));
    }

    struct NearestVisitor;
    struct EnclosingVisitor;
    template <class Visitor>
    void visitInstances(const LocalRay& ray, Visitor& visitor) const;
    void meet(std::uint32_t i, const LocalRay& worldRay, const SurfaceHit* left,
              NearestSurface& nearest) const;
    std::optional<MeshPoint> meetMesh(std::uint32_t i, const LocalRay& ray, double tMax,
                                      const SurfaceHit* left) const;
    bool encloses(std::uint32_t i, Vec3d point) const;
    void complete(const NearestSurface& nearest, const LocalRay& worldRay, SurfaceHit& hit) const;
    void completeMesh(const MeshPoint& point, SurfaceHit& hit) const;
    void completeShape(Vec3d p, SurfaceHit& hit) const;

    // ---- surfaces that coincide: geometry_coincident.cpp

    /// How far rounding may move a point off the plane of an instance's surface: the rounding of
    /// the numbers from which the point and the plane are computed.
    double reach(std::uint32_t i, std::uint32_t primitive, Vec3d normal, Vec3d point) const;
    /// The error of t that follows from it, at a hit at `t` along a ray.
    double slackOf(std::uint32_t i, const LocalRay& worldRay, const LocalRay& ray, double t,
                   const MeshPoint& point) const;
    /// The surface, if it passes through the position of a hit.
    std::optional<CoincidentSurface> passesThrough(const SurfaceHit& hit, std::uint32_t i,
                                                   std::uint32_t primitive) const;
};

}  // namespace woodcock::surface
