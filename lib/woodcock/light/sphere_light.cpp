// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/sphere_light.h"

#include <algorithm>
#include <cmath>

#include "woodcock/light/cone.h"

namespace woodcock::light {

namespace {

/// 1 - cos of the half angle that a sphere subtends, from (radius / distance)^2.
double apparentOneMinusCos(double sin2) { return sin2 / (1 + std::sqrt(1 - sin2)); }

}  // namespace

double SphereLight::hit(Vec3d origin, Vec3d direction) const {
    const Vec3d toCentre = position - origin;
    const double along = dot(toCentre, direction);
    const Vec3d across = toCentre - direction * along;
    const double inside = radius * radius - dot(across, across);
    const double t = along - std::sqrt(std::max(0.0, inside));
    return inside > 0 && t > 0 ? t : std::numeric_limits<double>::infinity();
}

LightSample SphereLight::sample(Vec3d from, double u0, double u1) const {
    const Vec3d d = position - from;
    const double distance = length(d), sin2 = radius / distance * (radius / distance);
    LightSample s;
    if (!(sin2 < 1)) return s;
    const double oneMinusCos = apparentOneMinusCos(sin2);
    s.direction = sampleCone(d / distance, oneMinusCos, u0, u1);
    s.pdf = 1 / (2 * pi * oneMinusCos);
    s.weight = radiance * static_cast<float>(1 / s.pdf);
    s.distance = hit(from, s.direction);
    if (!std::isfinite(s.distance)) s.distance = distance;  // the rim, missed by rounding
    return s;
}

double SphereLight::pdf(Vec3d from, Vec3d direction) const {
    const Vec3d d = position - from;
    const double distance = length(d), sin2 = radius / distance * (radius / distance);
    if (!(sin2 < 1)) return 0;
    const double oneMinusCos = apparentOneMinusCos(sin2);
    return oneMinusCosine(direction, d / distance) <= oneMinusCos ? 1 / (2 * pi * oneMinusCos) : 0;
}

double SphereLight::importance(const ScatterPoint& at) const {
    const Vec3d d = position - at.position;
    const double distance = std::max(length(d), radius);
    const double area = pi * radius * radius / (distance * distance);
    // Half by the phase function towards the centre, half as if isotropic: a wide light also sends
    // light from directions beside its centre.
    const double p = distance > radius ? at.phaseTowards(d / distance) : 0;
    return radiance.mean() * area * (0.5 * p + 0.5 / (4 * pi));
}

}  // namespace woodcock::light
