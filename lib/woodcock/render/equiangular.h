// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "woodcock/base/vec.h"

namespace woodcock::render {

/// Distances along a ray, within [t0, t1], in proportion to the inverse square distance to a light:
/// Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating
/// Media", sec. 4.
class Equiangular {
public:
    Equiangular() = default;  ///< samples nothing: its density is zero everywhere
    /// `leastDistance` > 0 is taken for the distance of a ray that goes through the light itself.
    /// `entry`: where the ray enters the medium, t0 or before.
    Equiangular(Vec3d origin, Vec3d direction, Vec3d lightPosition, double t0, double t1,
                double leastDistance, double entry)
        : entry_(entry), t0_(t0), t1_(t1), nearest_(dot(lightPosition - origin, direction)) {
        distance_ = std::max(length(origin + direction * nearest_ - lightPosition), leastDistance);
        angle0_ = std::atan2(t0 - nearest_, distance_);
        angle1_ = std::atan2(t1 - nearest_, distance_);
    }

    double entry() const { return entry_; }
    double sample(double u) const {
        return std::clamp(nearest_ + distance_ * std::tan(angle0_ + u * (angle1_ - angle0_)), t0_,
                          t1_);
    }
    /// The density, per unit of distance along the ray.
    double pdf(double t) const {
        if (!(angle1_ > angle0_) || t < t0_ || t > t1_) return 0;
        const double s = t - nearest_;
        return distance_ / ((angle1_ - angle0_) * (distance_ * distance_ + s * s));
    }

private:
    double entry_ = 0, t0_ = 0, t1_ = 0, nearest_ = 0, distance_ = 0, angle0_ = 0, angle1_ = 0;
};

}  // namespace woodcock::render
