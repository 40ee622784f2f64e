// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/flat_light.h"

#include <algorithm>
#include <cmath>

namespace woodcock::light {

FlatLight FlatLight::placed(const Affine3d& worldFromLight, double sizeX, double sizeZ) {
    const auto& [x, y, z] = worldFromLight.column;
    return {.centre = worldFromLight.translation,
            .x = normalize(x),
            .y = normalize(z),
            .normal = normalize(y),
            .halfX = sizeX * length(x) / 2,
            .halfY = sizeZ * length(z) / 2,
            .radiance = Rgb(1)};
}

FlatLight FlatLight::withForm(const LightForm& form) const {
    FlatLight flat = *this;
    flat.halfX = form[0], flat.halfY = form[1], flat.spread = Spread(form[2]);
    flat.radiance = colourOf(form, 3);
    return flat;
}

FlatPlace placeBefore(const FlatLight& light, Vec3d from) {
    const Vec3d d = from - light.centre;
    const double height = dot(d, light.normal);
    double sum = 0;  // of the terms whose difference is the height
    for (int axis = 0; axis < 3; ++axis)
        sum += std::abs(light.normal[axis]) * (std::abs(from[axis]) + std::abs(light.centre[axis]));
    constexpr double rounding = 0x1p-46;  // of a few transforms
    const bool dark = (height < 0 && !light.twoSided) || !(std::abs(height) > rounding * sum);
    return {dot(d, light.x), dot(d, light.y),
            dark ? std::numeric_limits<double>::quiet_NaN() : std::abs(height),
            height < 0 ? -1.0 : 1.0};
}

SeenRectangle seenPart(const FlatLight& light, const FlatPlace& from) {
    double x0 = -light.halfX, x1 = light.halfX, y0 = -light.halfY, y1 = light.halfY;
    if (!light.spread.even()) {
        const double reach = from.height * light.spread.tangent();
        x0 = std::max(x0, from.x - reach), x1 = std::min(x1, from.x + reach);
        y0 = std::max(y0, from.y - reach), y1 = std::min(y1, from.y + reach);
    }
    return {x0 - from.x, x1 - from.x, y0 - from.y, y1 - from.y, from.height};
}

LightSample sampleOf(const FlatLight& light, const FlatPlace& from, double x, double y,
                     double pdf) {
    const Vec3d d =
        light.x * (x - from.x) + light.y * (y - from.y) - light.normal * (from.side * from.height);
    LightSample s;
    s.distance = length(d);
    s.direction = d / s.distance;
    const double factor = light.spread.factor(from.height / s.distance);
    if (!(pdf > 0 && factor > 0)) return s;
    s.pdf = pdf;
    s.weight = light.radiance * static_cast<float>(factor / pdf);
    return s;
}

FlatHit meetPlane(const FlatLight& light, const FlatPlace& from, Vec3d direction) {
    const double cosine = -from.side * dot(direction, light.normal);
    if (!from.lit() || !(cosine > 0)) return {};
    const double factor = light.spread.factor(cosine);
    const double t = from.height / cosine;
    if (!(factor > 0) || !std::isfinite(t)) return {};
    return {from.x + t * dot(direction, light.x), from.y + t * dot(direction, light.y), t,
            light.radiance * static_cast<float>(factor)};
}

double importanceOf(const FlatLight& light, double area, const ScatterPoint& at) {
    const FlatPlace from = placeBefore(light, at.position);
    if (!from.lit()) return 0;
    const SeenRectangle seen = seenPart(light, from);
    if (seen.empty()) return 0;
    // By the middle of the part that is seen. Half by the phase function towards it, half as if
    // isotropic: a wide light also sends light from directions beside it.
    const auto [dx, dy] = seen.middle();
    const Vec3d d = light.x * dx + light.y * dy - light.normal * (from.side * from.height);
    const double distance = length(d), cosine = from.height / distance;
    const double projected = std::min(area, seen.area()) * cosine;
    const double solidAngle = projected / (distance * distance + projected / (2 * pi));
    // Beside the middle, the spread may let more through.
    const double factor = std::max(light.spread.factor(cosine), 0.1 * light.spread.largest());
    return light.radiance.mean() * factor * solidAngle *
           (0.5 * at.phaseTowards(d / distance) + 0.5 / (4 * pi));
}

void narrowTo(const FlatLight& light, Vec3d origin, Vec3d direction, double& t0, double& t1) {
    if (light.twoSided) return;
    const double height = dot(origin - light.centre, light.normal);
    const double rise = dot(direction, light.normal), t = -height / rise;
    if (rise > 0)
        t0 = std::clamp(t, t0, t1);
    else if (rise < 0)
        t1 = std::clamp(t, t0, t1);
    else if (!(height > 0))
        t1 = t0;
}

}  // namespace woodcock::light
