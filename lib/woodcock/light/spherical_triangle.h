// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "woodcock/base/vec.h"

namespace woodcock::light {

/// A triangle projected onto the unit sphere around a point.
class SphericalTriangle {
public:
    SphericalTriangle(const std::array<Vec3d, 3>& corner, Vec3d from);

    /// From 0 to 2 pi. 0 in the triangle's own plane, and where the point is a corner. All digits
    /// are right, however small it is.
    double solidAngle() const { return solidAngle_; }
    /// The point is on the side from which the corners run counter-clockwise.
    bool front() const { return front_; }

    bool contains(Vec3d direction) const;
    /// A direction into the triangle, uniform in solid angle, by u in [0, 1)^2. Not for solid
    /// angles so close to 2 pi that the point lies in the triangle's plane but for rounding.
    Vec3d sample(double u0, double u1) const;

private:
    std::array<Vec3d, 3> corner_;                   // directions
    double determinant_ = 0, side_ = 0, rest_ = 0;  // of Peters 2021: G0, G2, G1
    double solidAngle_ = 0;
    bool front_ = false;
};

}  // namespace woodcock::light
