// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "woodcock/base/affine.h"

namespace woodcock {

/// A unit quaternion: the rotation by an angle a about a unit axis n is (cos a/2, n sin a/2).
struct Quaternion {
    double w = 1;
    Vec3d v{};
};

/// A map as a stretch, then a rotation, then a translation: p -> R S p + translation. S is
/// symmetric; it is positive, or, where the map mirrors, negative. Shoemake and Duff 1992, "Matrix
/// Animation and Polar Decomposition".
struct PolarMap {
    Vec3d translation{};
    Quaternion rotation{};
    std::array<Vec3d, 3> stretch{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};  ///< columns

    Affine3d map() const;
};

/// `map` must be regular: see flawOf().
PolarMap polarOf(const Affine3d& map);

/// The way from a to b at s in [0, 1]: the rotation turns evenly about one axis, by the smaller
/// angle; the stretch and the translation go straight. Between regular maps that both mirror, or
/// both do not, every one is regular.
PolarMap between(const PolarMap& a, const PolarMap& b, double s);

/// The angle by which that way turns, in radians.
double angleBetween(const Quaternion& a, const Quaternion& b);

}  // namespace woodcock
