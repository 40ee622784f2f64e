// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "woodcock/mesh/surface_mesh.h"
#include "woodcock/surface/embree_tree.h"
#include "woodcock/surface/geometry_solve.h"

namespace woodcock::surface {

/// A box moved to the origin and scaled to about unit size, by a power of two, which is exact.
struct Frame {
    Vec3d centre;
    double scale = 1;

    Frame() = default;
    explicit Frame(const Box3d& box);
    Vec3d point(Vec3d p) const { return (p - centre) * scale; }
};

struct MeshPoint {
    double t = 0;
    std::uint32_t triangle = 0;
    std::array<double, 3> weights{};
    double slope = 1;         ///< direction . unit normal, of the side that faces the ray
    double slack = 0;         ///< the largest error of t from rounding of its corners
    bool coincident = false;  ///< another triangle was met, and rounding cannot tell them apart
};

/// A mesh with its tree, in a frame of its own in which floats are precise at the mesh's size.
/// Embree finds candidates; each is decided on in double, along the ray itself and without an
/// offset.
class FramedMesh {
public:
    /// The mesh has triangles, and outlives this; so does the device.
    FramedMesh(const mesh::SurfaceMesh& mesh, const EmbreeDevice& device);

    const mesh::SurfaceMesh& mesh() const { return *mesh_; }
    const Frame& frame() const { return frame_; }
    const Box3d& box() const { return box_; }  ///< in its frame
    Triangle triangle(std::uint32_t index) const;

    /// How far floats may have moved a triangle along its unit normal, in its frame: twice half of
    /// the last digit of its corners' coordinates.
    double rounding(std::uint32_t index, Vec3d normal) const;
    double largestRounding() const {
        return largestRounding_;
    }  ///< a bound of rounding() over all triangles

    using TestsTriangle = std::function<bool(std::uint32_t, const Triangle&)>;
    /// The nearest triangle in (0, tMax). `left`: the triangle that the ray starts on; `alsoLeft`
    /// says which other triangles it starts on.
    std::optional<MeshPoint> nearest(const LocalRay& ray, double tMax,
                                     std::optional<std::uint32_t> left,
                                     const TestsTriangle& alsoLeft = {}) const;
    /// Calls `visit` with all triangles that may lie within a radius of a point.
    void around(Vec3d point, double radius, const std::function<void(std::uint32_t)>& visit) const;
    /// Whether a ray from a point leaves through more triangles than it enters through.
    bool encloses(Vec3d point) const;

private:
    const mesh::SurfaceMesh* mesh_;
    Frame frame_;
    Box3d box_;
    double largestRounding_ = 0;
    EmbreeTree tree_;
};

}  // namespace woodcock::surface
