// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/spherical_triangle.h"

namespace woodcock::light {

SphericalTriangle::SphericalTriangle(const std::array<Vec3d, 3>& corner, Vec3d from) {
    std::array<double, 3> distance{};
    for (std::size_t i = 0; i < 3; ++i) {
        corner_[i] = corner[i] - from;
        distance[i] = length(corner_[i]);
        if (!(distance[i] > 0)) return;
        corner_[i] = corner_[i] / distance[i];
    }
    // det(a, b, c) = det(a, b - a, c - a). The edges are differences of corners, so that small
    // triangles far away lose no digits.
    const Vec3d e1 = (corner[1] - corner[0]) / distance[1];
    const Vec3d e2 = (corner[2] - corner[0]) / distance[2];
    const double determinant = dot(corner_[0], cross(e1, e2));
    front_ = determinant < 0;
    determinant_ = std::abs(determinant);
    const Vec3d sum = corner_[0] + corner_[1];
    side_ = dot(sum, sum) / 2;  // 1 + cos, also where they are opposite
    rest_ = dot(sum, corner_[2]);
    // Van Oosterom and Strackee 1983, eq. 8
    solidAngle_ = determinant_ > 0 ? 2 * std::atan2(determinant_, side_ + rest_) : 0;
}

bool SphericalTriangle::contains(Vec3d direction) const {
    for (std::size_t i = 0; i < 3; ++i) {
        const double side = dot(direction, cross(corner_[i], corner_[(i + 1) % 3]));
        if (front_ ? side > 0 : side < 0) return false;
    }
    return solidAngle_ > 0;
}

// Peters 2021, "BRDF Importance Sampling for Polygonal Lights", section 4: a corner moves along
// the edge between the first and the last until it cuts off u0 of the solid angle. The tangent of
// half of that is linear in the half vector r of that edge. Then the arc from the second corner to
// it is sampled, as by Arvo 1995.
Vec3d SphericalTriangle::sample(double u0, double u1) const {
    const auto& [a, b, c] = corner_;
    const double angle = u0 * solidAngle_ / 2, sine = std::sin(angle);
    const Vec3d r = a * (determinant_ * std::cos(angle) - rest_ * sine) + c * (side_ * sine);
    const Vec3d moved = r * (2 * dot(a, r) / dot(r, r)) - a;

    const Vec3d sum = b + moved;
    const double onePlusCos = dot(sum, sum) / 2;  // of the arc
    const double s = 1 - u1 * (2 - onePlusCos);
    const double t = std::sqrt(std::max(0.0, u1 * (1 + s) / onePlusCos));
    return normalize(b * (s - t * (onePlusCos - 1)) + moved * t);
}

}  // namespace woodcock::light
