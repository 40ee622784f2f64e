// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/light/light_sample.h"

namespace woodcock::light {

/// Parallel rays, or a disc of uniform radiance in the sky.
class Sun {
public:
    /// `travel`: the direction in which its light goes (world). `irradiance`: on a surface
    /// perpendicular to it.
    Sun(Vec3d travel, Rgb irradiance, double angularDiameterDegrees, bool visible);

    bool delta() const { return sinHalf_ == 0; }
    bool visible() const { return visible_; }
    Rgb irradiance() const { return irradiance_; }
    Vec3d towards() const { return towards_; }
    Rgb radiance(Vec3d direction) const;  ///< of the disc; 0 for delta

    LightTraits traits() const {
        LightTraits traits{.name = "a sun", .distant = !delta(), .visible = visible_};
        constexpr double widest = 0.0174524064372835;  // the sine of a degree
        if (sinHalf_ <= widest) traits.parallel = towards_;
        return traits;
    }
    LightSample sample(Vec3d from, double u0, double u1) const;
    double pdf(Vec3d from, Vec3d direction) const;  ///< 0 outside the disc and for delta
    double importance(const ScatterPoint& at) const {
        return irradiance_.mean() * at.phaseTowards(towards_);
    }
    double typicalRadiance(const Box3d&) const { return irradiance_.maximum() / (4 * pi); }
    Rgb distantRadiance(Vec3d direction) const { return radiance(direction); }
    /// What floats cannot hold of it; empty: nothing.
    std::string flaw() const;

private:
    Vec3d towards_;
    Rgb irradiance_;
    double sinHalf_, oneMinusCos_;  // of half the angular diameter
    bool visible_;
};

}  // namespace woodcock::light
