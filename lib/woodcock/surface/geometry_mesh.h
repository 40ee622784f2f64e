// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "woodcock/mesh/surface_mesh.h"
#include "woodcock/surface/embree_tree.h"
#include "woodcock/surface/geometry_solve.h"

namespace woodcock {

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
};

/// A mesh in a frame of its own, in which floats are as precise as it is large, with its tree.
/// Embree finds candidates; each is decided on in double, along the ray itself and with no offset.
class FramedMesh {
public:
    /// The mesh has triangles, and outlives this; so does the device.
    FramedMesh(const SurfaceMesh& mesh, const EmbreeDevice& device);

    const SurfaceMesh& mesh() const { return *mesh_; }
    const Frame& frame() const { return frame_; }
    const Box3d& box() const { return box_; }  ///< in its frame
    Triangle triangle(std::uint32_t index) const;

    /// The nearest triangle in (0, tMax). `left`: the triangle that the ray starts on.
    std::optional<MeshPoint> nearest(const LocalRay& ray, double tMax,
                                     std::optional<std::uint32_t> left) const;
    /// Whether more triangles are left through than entered on the way out from a point.
    bool encloses(Vec3d point) const;

private:
    const SurfaceMesh* mesh_;
    Frame frame_;
    Box3d box_;
    EmbreeTree tree_;
};

}  // namespace woodcock
