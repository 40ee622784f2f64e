// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/light.h"

namespace woodcock::light {

namespace {

/// A direction inside the cone of 1 - cos(half angle) = `oneMinusCos` around `axis`, uniform in
/// solid angle. 1 - cos is passed as such, so that tiny angles lose no digits.
Vec3d sampleCone(Vec3d axis, double oneMinusCos, double u0, double u1) {
    const double below = u0 * oneMinusCos;
    const double sine = std::sqrt(below * (2 - below)), phi = 2 * pi * u1;
    Vec3d s, t;
    orthonormalBasis(axis, s, t);
    return normalize(s * (sine * std::cos(phi)) + t * (sine * std::sin(phi)) + axis * (1 - below));
}

/// 1 - cos of the angle between unit vectors, exact for small angles.
double oneMinusCosine(Vec3d a, Vec3d b) { return dot(a - b, a - b) / 2; }

/// 1 - cos of the half angle that a sphere subtends, from (radius / distance)^2.
double apparentOneMinusCos(double sin2) { return sin2 / (1 + std::sqrt(1 - sin2)); }

}  // namespace

Sun::Sun(Vec3d travel, Rgb irradiance, double angularDiameterDegrees, bool visible)
    : towards_(-normalize(travel)),
      irradiance_(irradiance),
      sinHalf_(std::sin(angularDiameterDegrees * pi / 360)),
      visible_(visible) {
    const double s = std::sin(angularDiameterDegrees * pi / 720);
    oneMinusCos_ = 2 * s * s;
}

LightSample Sun::sample(double u0, double u1) const {
    LightSample s;
    if (delta()) {
        s.direction = towards_, s.weight = irradiance_;
        return s;
    }
    s.direction = sampleCone(towards_, oneMinusCos_, u0, u1);
    s.pdf = 1 / (2 * pi * oneMinusCos_);
    s.weight = radiance(towards_) * static_cast<float>(1 / s.pdf);
    return s;
}

double Sun::pdf(Vec3d direction) const {
    if (delta() || oneMinusCosine(direction, towards_) > oneMinusCos_) return 0;
    return 1 / (2 * pi * oneMinusCos_);
}

Rgb Sun::radiance(Vec3d direction) const {
    if (delta() || oneMinusCosine(direction, towards_) > oneMinusCos_) return {};
    return irradiance_ * static_cast<float>(1 / (pi * sinHalf_ * sinHalf_));
}

Environment::Environment(EnvironmentMap map, Rgb scale, const Affine3d& worldFromLight,
                         bool visible)
    : map_(std::move(map)),
      scale_(scale),
      worldFromLight_(worldFromLight),
      lightFromWorld_(worldFromLight.inverse()),
      visible_(visible) {}

Rgb Environment::meanRadiance() const { return constant() ? scale_ : scale_ * map_.meanRadiance(); }

Rgb Environment::radiance(Vec3d direction) const {
    return constant() ? scale_ : scale_ * map_.radiance(lightFromWorld_.vector(direction));
}

LightSample Environment::sample(double u0, double u1) const {
    const EnvironmentMap::Sample m = map_.sample(u0, u1);
    LightSample s;
    s.direction = worldFromLight_.vector(m.direction), s.pdf = m.pdf;
    if (m.pdf > 0) s.weight = scale_ * map_.radiance(m.direction) * static_cast<float>(1 / m.pdf);
    return s;
}

double Environment::pdf(Vec3d direction) const {
    return constant() ? 0 : map_.pdf(lightFromWorld_.vector(direction));
}

LightSample PointLight::sample(Vec3d from) const {
    const Vec3d d = position - from;
    LightSample s;
    s.distance = length(d);
    if (!(s.distance > 0)) return s;
    s.direction = d / s.distance;
    s.weight = intensity * static_cast<float>(1 / (s.distance * s.distance));
    return s;
}

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

}  // namespace woodcock::light
