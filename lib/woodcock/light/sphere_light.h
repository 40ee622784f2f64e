// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/light/light_sample.h"

namespace woodcock::light {

/// A sphere that emits uniform radiance outwards and lets other light pass. It emits nothing
/// inwards.
struct SphereLight {
    Vec3d position;
    double radius;
    Rgb radiance;
    bool visible = true;

    LightTraits traits() const {
        return {.name = "a sphere light",
                .position = position,
                .visible = visible,
                .intensity = radiance.maximum() * pi * radius * radius};
    }
    LightSample sample(Vec3d from, double u0, double u1) const;  ///< weight 0 from inside
    double pdf(Vec3d from, Vec3d direction) const;
    double importance(const ScatterPoint& at) const;
    double typicalRadiance(const Box3d& bounds) const {
        return radianceOfLocalLight(position, traits().intensity, bounds);
    }
    LightHit meet(Vec3d origin, Vec3d direction) const {
        return {hit(origin, direction), radiance};
    }
    /// Distance at which a ray from outside enters the sphere; infinity when the ray misses it.
    double hit(Vec3d origin, Vec3d direction) const;
    LightForm form() const { return {radius, radiance[0], radiance[1], radiance[2]}; }
    SphereLight withForm(const LightForm& form) const {
        return {position, form[0], colourOf(form, 1), visible};
    }
};

}  // namespace woodcock::light
