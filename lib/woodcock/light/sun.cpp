// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/sun.h"

#include <fmt/format.h>

#include <cmath>

#include "woodcock/light/cone.h"

namespace woodcock::light {

Sun::Sun(Vec3d travel, Rgb irradiance, double angularDiameterDegrees, bool visible)
    : towards_(-normalize(travel)),
      irradiance_(irradiance),
      sinHalf_(std::sin(angularDiameterDegrees * pi / 360)),
      visible_(visible) {
    const double s = std::sin(angularDiameterDegrees * pi / 720);
    oneMinusCos_ = 2 * s * s;
}

LightSample Sun::sample(Vec3d, double u0, double u1) const {
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

double Sun::pdf(Vec3d, Vec3d direction) const {
    if (delta() || oneMinusCosine(direction, towards_) > oneMinusCos_) return 0;
    return 1 / (2 * pi * oneMinusCos_);
}

Rgb Sun::radiance(Vec3d direction) const {
    if (delta() || oneMinusCosine(direction, towards_) > oneMinusCos_) return {};
    return irradiance_ * static_cast<float>(1 / (pi * sinHalf_ * sinHalf_));
}

std::string Sun::flaw() const {
    if (delta() ||
        (std::isfinite(radiance(towards_).maximum()) && std::isfinite(pdf({}, towards_))))
        return {};
    return fmt::format(
        "a sun is so narrow that the radiance of its disc is beyond the largest float, {:g}; give "
        "angular_diameter = 0 for parallel rays",
        double{std::numeric_limits<float>::max()});
}

}  // namespace woodcock::light
