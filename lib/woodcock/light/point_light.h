// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "woodcock/base/affine.h"
#include "woodcock/light/ies_profile.h"
#include "woodcock/light/light_sample.h"

namespace woodcock::light {

/// A point that shines evenly, or as a profile says.
struct PointLight {
    Vec3d position;
    Rgb intensity;                                        ///< power per solid angle
    std::shared_ptr<const IesProfile> profile = nullptr;  ///< multiplies it; null: one
    Affine3d lightFromWorld = {};                         ///< of directions: the profile's axes

    LightTraits traits() const {
        const double most = profile ? profile->maximum() : 1;
        return {
            .name = "a point light", .position = position, .intensity = intensity.maximum() * most};
    }
    LightSample sample(Vec3d from, double u0, double u1) const;
    double pdf(Vec3d, Vec3d) const { return 0; }
    double importance(const ScatterPoint& at) const;
    double typicalRadiance(const Box3d& bounds) const {
        return radianceOfLocalLight(position, traits().intensity, bounds);
    }
    LightForm form() const { return {intensity[0], intensity[1], intensity[2]}; }
    PointLight withForm(const LightForm& form) const {
        return {position, colourOf(form, 0), profile, lightFromWorld};
    }
};

}  // namespace woodcock::light
