// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/affine.h"
#include "woodcock/light/environment_map.h"
#include "woodcock/light/light_sample.h"

namespace woodcock::light {

/// Radiance from all around: a constant, or a lat-long image times one.
class Environment {
public:
    Environment(Rgb radiance, bool visible) : scale_(radiance), visible_(visible) {}
    Environment(EnvironmentMap map, Rgb scale, const Affine3d& worldFromLight, bool visible);
    /// A sun that EnvironmentMap::takeSun() has found.
    Environment(EnvironmentMap::Sun sun, Rgb scale, const Affine3d& worldFromLight, bool visible);

    bool constant() const { return map_.empty(); }
    bool visible() const { return visible_; }
    const EnvironmentMap& map() const { return map_; }
    Rgb meanRadiance() const;  ///< over the sphere
    Rgb radiance(Vec3d direction) const;

    LightTraits traits() const {
        return {.name = "an environment",
                .sampled = !constant(),
                .distant = true,
                .visible = visible_,
                .parallel = sun_};
    }
    LightSample sample(Vec3d from, double u0, double u1) const;  ///< of the image
    double pdf(Vec3d from, Vec3d direction) const;
    double importance(const ScatterPoint&) const { return double{meanRadiance().mean()}; }
    double typicalRadiance(const Box3d&) const { return double{meanRadiance().maximum()}; }
    Rgb distantRadiance(Vec3d direction) const { return radiance(direction); }

private:
    EnvironmentMap map_;
    Rgb scale_;
    Affine3d worldFromLight_, lightFromWorld_;
    bool visible_;
    std::optional<Vec3d> sun_;  ///< the direction to it, in the world, where it is one
};

}  // namespace woodcock::light
