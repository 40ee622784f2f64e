// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "woodcock/base/vec.h"

namespace woodcock::surface {

/// A ray in a shape's own frame. Its parameter t is that of the ray in the world.
struct LocalRay {
    Vec3d origin, direction;
    Vec3d at(double t) const { return origin + direction * t; }
};

/// The part of a ray within a box that is `margin` larger on all sides, from `from` to `to`.
struct RayInterval {
    double from = 0, to = 0;
    bool empty() const { return !(from <= to); }
};
RayInterval clip(const LocalRay& ray, const Box3d& box, double margin, RayInterval within);

/// How far from the ray the candidates of Embree may lie, by the rounding of floats, in a frame of
/// about unit size.
inline constexpr double floatError = 0x1p-21;

/// The unit sphere's nearest point in (0, tMax).
std::optional<double> meetSphere(const LocalRay& ray, double tMax);
/// Where a ray that starts on the sphere, inwards, leaves it.
double crossSphere(const LocalRay& ray);
/// Where the ray meets y = 0, in (0, tMax).
std::optional<double> meetPlane(const LocalRay& ray, double tMax);

struct Triangle {
    std::array<Vec3d, 3> corner;
    Vec3d normal;  ///< not of unit length: twice the area

    explicit Triangle(const std::array<Vec3d, 3>& c)
        : corner(c), normal(cross(c[1] - c[0], c[2] - c[0])) {}
    Vec3d at(const std::array<double, 3>& weights) const {
        return corner[0] * weights[0] + corner[1] * weights[1] + corner[2] * weights[2];
    }
};

struct TrianglePoint {
    double t = 0;
    std::array<double, 3> weights{};  ///< barycentric, none negative
    bool within = true;  ///< false: the ray passes the triangle, by no more than the error
    double tolerance =
        0;  ///< the error along the triangle that follows from the error beside the ray
};
/// Where a ray meets a triangle that was found in floats. A ray that passes it by no more than the
/// error of the search meets it at its edge, so that there are no cracks. Absent where it surely
/// passes, or is parallel. `speed`: the length of the ray's direction.
std::optional<TrianglePoint> meetTriangle(const LocalRay& ray, double speed,
                                          const Triangle& triangle, double error);

/// Barycentric weights of a point in a triangle's plane, or of its projection there.
std::array<double, 3> weightsAt(const Triangle& triangle, Vec3d point);
/// The distance from the nearest edge of the point with these weights; negative: outside.
double edgeDistance(const Triangle& triangle, const std::array<double, 3>& weights);
/// True only where the edgeDistance() of the point's weights is below -margin, and nearly always
/// then, but for points that are many times the triangle's size away from it. It takes a fraction
/// of the time. The triangle is of about unit size; the margin is 2^-40 at least.
bool surelyBeside(const Triangle& triangle, Vec3d point, double margin);

/// Weights moved inwards so that their point is `margin` away from all edges, or the middle of the
/// triangle.
std::array<double, 3> awayFromEdges(const Triangle& triangle, std::array<double, 3> weights,
                                    double margin);

}  // namespace woodcock::surface
