// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/spot_light.h"

#include <algorithm>
#include <array>

#include "woodcock/light/cone.h"

namespace woodcock::light {

SpotLight::SpotLight(Vec3d position, Vec3d direction, Rgb intensity, double coneDegrees,
                     double blend)
    : position_(position), axis_(normalize(direction)), intensity_(intensity) {
    const double s = std::sin(coneDegrees * pi / 720);
    oneMinusCos_ = 2 * s * s;
    cosHalf_ = coneDegrees == 180 ? 0 : std::cos(coneDegrees * pi / 360);
    edge_ = oneMinusCos_ * blend;
}

SpotLight SpotLight::withForm(const LightForm& form) const {
    SpotLight spot = *this;
    spot.oneMinusCos_ = form[0], spot.cosHalf_ = 1 - form[0], spot.edge_ = form[1];
    spot.intensity_ = colourOf(form, 2);
    return spot;
}

double SpotLight::fallOff(double oneMinusCos) const {
    const double inside = oneMinusCos_ - oneMinusCos;  // cos - cosHalf
    if (!(inside > 0)) return 0;
    if (inside >= edge_) return 1;
    const double x = inside / edge_;
    return x * x * (3 - 2 * x);
}

LightSample SpotLight::sample(Vec3d from, double, double) const {
    const Vec3d d = position_ - from;
    LightSample s;
    s.distance = length(d);
    if (!(s.distance > 0)) return s;
    s.direction = d / s.distance;
    s.weight = intensity_ * static_cast<float>(fallOff(oneMinusCosine(-s.direction, axis_)) /
                                               (s.distance * s.distance));
    return s;
}

double SpotLight::importance(const ScatterPoint& at) const {
    const LightSample s = sample(at.position, 0, 0);
    const double light = s.weight.mean();
    return light > 0 ? light * at.phaseTowards(s.direction) : 0;
}

void SpotLight::narrow(Vec3d origin, Vec3d direction, double& t0, double& t1) const {
    // The cone is (q.axis)^2 >= cos^2 q.q with q.axis >= 0: it is convex, so one interval of the
    // ray lies in it. Between the roots of the quadratic a ray is wholly inside or wholly outside.
    const Vec3d o = origin - position_;
    const double cos2 = cosHalf_ * cosHalf_, along = dot(direction, axis_), height = dot(o, axis_);
    const double a = along * along - cos2, b = along * height - cos2 * dot(o, direction);
    const double c = height * height - cos2 * dot(o, o);
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    const double q = -(b + std::copysign(root, b));
    std::array<double, 2> cut{a != 0 ? q / a : t0, q != 0 ? c / q : t0};
    for (double& t : cut) t = std::isnan(t) ? t0 : std::clamp(t, t0, t1);
    if (cut[0] > cut[1]) std::swap(cut[0], cut[1]);
    const auto lit = [&](double from, double to) {
        if (!(from < to)) return false;
        const double t = std::isfinite(to) ? from + (to - from) / 2 : 2 * std::abs(from) + 1;
        const Vec3d p = o + direction * t;
        return dot(p, axis_) >= cosHalf_ * length(p);
    };
    const bool first = lit(t0, cut[0]), second = lit(cut[0], cut[1]), third = lit(cut[1], t1);
    const double begin = first ? t0 : second ? cut[0] : third ? cut[1] : t1;
    const double end = third ? t1 : second ? cut[1] : first ? cut[0] : t1;
    t0 = begin, t1 = end;
}

}  // namespace woodcock::light
