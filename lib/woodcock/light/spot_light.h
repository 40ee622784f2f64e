// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/light/light_sample.h"

namespace woodcock::light {

/// A point that shines into a cone.
class SpotLight {
public:
    /// `direction`: the cone's axis, of any length. `intensity`: power per solid angle along it.
    /// `coneDegrees`: the whole angle, in (0, 180]. `blend`, in [0, 1]: how much of the cone, as
    /// a part of 1 - cos(half angle), the soft edge takes; 0: the edge is hard.
    SpotLight(Vec3d position, Vec3d direction, Rgb intensity, double coneDegrees, double blend);

    /// Of the intensity, at an angle of this 1 - cos to the axis: smoothstep((cos - cosHalf) /
    /// (blend (1 - cosHalf))), where smoothstep(x) = x^2 (3 - 2x) between 0 and 1, as in Cycles.
    double fallOff(double oneMinusCos) const;

    LightTraits traits() const {
        return {.name = "a spot light",
                .position = position_,
                .intensity = double{intensity_.maximum()}};
    }
    LightSample sample(Vec3d from, double u0, double u1) const;
    double pdf(Vec3d, Vec3d) const { return 0; }
    double importance(const ScatterPoint& at) const;
    double typicalRadiance(const Box3d& bounds) const {
        return radianceOfLocalLight(position_, intensity_.maximum(), bounds);
    }
    /// Narrows [t0, t1] to the part of the ray that lies in the cone.
    void narrow(Vec3d origin, Vec3d direction, double& t0, double& t1) const;
    LightForm form() const {
        return {oneMinusCos_, edge_, intensity_[0], intensity_[1], intensity_[2]};
    }
    SpotLight withForm(const LightForm& form) const;

private:
    Vec3d position_, axis_;
    Rgb intensity_;
    double cosHalf_, oneMinusCos_;  // of half the cone's angle
    double edge_;                   // 1 - cos, of the soft edge
};

}  // namespace woodcock::light
