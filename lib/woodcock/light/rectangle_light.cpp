// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/rectangle_light.h"

#include <cmath>

namespace woodcock::light {

namespace {

bool contains(const FlatLight& light, const FlatHit& hit) {
    return std::isfinite(hit.distance) && std::abs(hit.x) <= light.halfX &&
           std::abs(hit.y) <= light.halfY;
}

}  // namespace

LightSample RectangleLight::sample(Vec3d from, double u0, double u1) const {
    const FlatPlace place = placeBefore(flat, from);
    if (!place.lit()) return {};
    const SeenRectangle seen = seenPart(flat, place);
    if (seen.empty()) return {};
    const auto [dx, dy] = seen.sample(u0, u1);
    return sampleOf(flat, place, place.x + dx, place.y + dy, seen.pdf(dx, dy));
}

double RectangleLight::pdf(Vec3d from, Vec3d direction) const {
    const FlatPlace place = placeBefore(flat, from);
    const FlatHit hit = meetPlane(flat, place, direction);
    if (!contains(flat, hit)) return 0;
    return seenPart(flat, place).pdf(hit.x - place.x, hit.y - place.y);
}

LightHit RectangleLight::meet(Vec3d origin, Vec3d direction) const {
    const FlatHit hit = meetPlane(flat, placeBefore(flat, origin), direction);
    return contains(flat, hit) ? LightHit{hit.distance, hit.radiance} : LightHit();
}

}  // namespace woodcock::light
