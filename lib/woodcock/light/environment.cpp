// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/environment.h"

namespace woodcock::light {

Environment::Environment(EnvironmentMap map, Rgb scale, const Affine3d& worldFromLight,
                         bool visible)
    : map_(std::move(map)),
      scale_(scale),
      worldFromLight_(worldFromLight),
      lightFromWorld_(worldFromLight.inverse()),
      visible_(visible) {}

Environment::Environment(EnvironmentMap::Sun sun, Rgb scale, const Affine3d& worldFromLight,
                         bool visible)
    : Environment(std::move(sun.map), scale, worldFromLight, visible) {
    sun_ = normalize(worldFromLight.vector(sun.direction));
}

Rgb Environment::meanRadiance() const { return constant() ? scale_ : scale_ * map_.meanRadiance(); }

Rgb Environment::radiance(Vec3d direction) const {
    return constant() ? scale_ : scale_ * map_.radiance(lightFromWorld_.vector(direction));
}

LightSample Environment::sample(Vec3d, double u0, double u1) const {
    const EnvironmentMap::Sample m = map_.sample(u0, u1);
    LightSample s;
    s.direction = worldFromLight_.vector(m.direction), s.pdf = m.pdf;
    if (m.pdf > 0) s.weight = scale_ * map_.radiance(m.direction) * static_cast<float>(1 / m.pdf);
    return s;
}

double Environment::pdf(Vec3d, Vec3d direction) const {
    return constant() ? 0 : map_.pdf(lightFromWorld_.vector(direction));
}

}  // namespace woodcock::light
