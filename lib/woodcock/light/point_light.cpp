// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/point_light.h"

namespace woodcock::light {

LightSample PointLight::sample(Vec3d from, double, double) const {
    const Vec3d d = position - from;
    LightSample s;
    s.distance = length(d);
    if (!(s.distance > 0)) return s;
    s.direction = d / s.distance;
    s.weight = intensity * static_cast<float>(1 / (s.distance * s.distance));
    if (profile)
        s.weight *= static_cast<float>(profile->value(lightFromWorld.vector(-s.direction)));
    return s;
}

double PointLight::importance(const ScatterPoint& at) const {
    const LightSample s = sample(at.position, 0, 0);
    return s.weight.mean() * at.phaseTowards(s.direction);
}

}  // namespace woodcock::light
