// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock::light {

/// How a flat light's radiance depends on the angle to its normal. A grid of deep slats in front of
/// an even emitter lets through what is within `degrees` / 2 of the normal, and the more the closer
/// to it. The power stays that of the even emitter. As in Cycles.
class Spread {
public:
    explicit Spread(double degrees = 180);  ///< the whole angle, in (0, 180]; 180: even

    double degrees() const { return degrees_; }
    bool even() const { return even_; }
    /// What multiplies the radiance: with a = degrees / 2, (tan a - tan angle) / (tan a - a); the
    /// integral of this times the cosine over the hemisphere is pi for every spread.
    double factor(double cosine) const;
    double largest() const { return even_ ? 1 : tangent_ / rest_; }  ///< along the normal
    double tangent() const { return tangent_; }                      ///< of a; not if even()

private:
    double degrees_;
    bool even_;
    double tangent_ = 0, rest_ = 1;  // tan a, tan a - a
};

}  // namespace woodcock::light
