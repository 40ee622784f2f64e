// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/light/flat_light.h"

namespace woodcock::light {

/// A rectangle that emits.
struct RectangleLight {
    FlatLight flat;

    double area() const { return 4 * flat.halfX * flat.halfY; }
    LightTraits traits() const {
        return {.name = "a rectangle light",
                .position = flat.centre,
                .visible = flat.visible,
                .intensity = flat.radiance.maximum() * flat.spread.largest() * area()};
    }
    LightSample sample(Vec3d from, double u0, double u1) const;  ///< weight 0 from its dark side
    double pdf(Vec3d from, Vec3d direction) const;
    double importance(const ScatterPoint& at) const { return importanceOf(flat, area(), at); }
    double typicalRadiance(const Box3d& bounds) const {
        return radianceOfLocalLight(flat.centre, flat.radiance.maximum() * area(), bounds);
    }
    LightHit meet(Vec3d origin, Vec3d direction) const;
    void narrow(Vec3d origin, Vec3d direction, double& t0, double& t1) const {
        narrowTo(flat, origin, direction, t0, t1);
    }
    LightForm form() const { return flat.form(); }
    RectangleLight withForm(const LightForm& form) const { return {flat.withForm(form)}; }
};

}  // namespace woodcock::light
