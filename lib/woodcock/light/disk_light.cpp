// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/disk_light.h"

#include <algorithm>
#include <cmath>

namespace woodcock::light {

namespace {

bool contains(const FlatLight& light, double x, double y) {
    const double a = x / light.halfX, b = y / light.halfY;
    return a * a + b * b <= 1;
}

/// Whether the disk is sampled evenly by area. That serves where its points are of similar
/// distance, and all can send light. Elsewhere the rectangle around it is sampled by solid angle,
/// and of the directions that miss the disk, at most 1 - pi/4 from afar, none counts.
bool sampledByArea(const FlatLight& light, const FlatPlace& from) {
    const double radius = std::max(light.halfX, light.halfY);
    const double beside = std::hypot(from.x, from.y), h = from.height;
    const double nearest = std::hypot(h, std::max(0.0, beside - radius));
    const double farthest = std::hypot(h, beside + radius);
    return farthest <= 2 * nearest &&
           (light.spread.even() || beside + radius <= h * light.spread.tangent());
}

double areaPdf(double area, const FlatPlace& from, double x, double y) {
    const double distance = std::hypot(x - from.x, y - from.y, from.height);
    return distance * distance * distance / (area * from.height);
}

}  // namespace

LightSample DiskLight::sample(Vec3d from, double u0, double u1) const {
    const FlatPlace place = placeBefore(flat, from);
    if (!place.lit()) return {};
    if (sampledByArea(flat, place)) {
        const double r = std::sqrt(u0), phi = 2 * pi * u1;
        const double x = flat.halfX * r * std::cos(phi), y = flat.halfY * r * std::sin(phi);
        return sampleOf(flat, place, x, y, areaPdf(area(), place, x, y));
    }
    const SeenRectangle seen = seenPart(flat, place);
    if (seen.empty()) return {};
    const auto [dx, dy] = seen.sample(u0, u1);
    const double x = place.x + dx, y = place.y + dy;
    return sampleOf(flat, place, x, y, contains(flat, x, y) ? seen.pdf(dx, dy) : 0);
}

double DiskLight::pdf(Vec3d from, Vec3d direction) const {
    const FlatPlace place = placeBefore(flat, from);
    const FlatHit hit = meetPlane(flat, place, direction);
    if (!std::isfinite(hit.distance) || !contains(flat, hit.x, hit.y)) return 0;
    if (sampledByArea(flat, place)) return areaPdf(area(), place, hit.x, hit.y);
    return seenPart(flat, place).pdf(hit.x - place.x, hit.y - place.y);
}

LightHit DiskLight::meet(Vec3d origin, Vec3d direction) const {
    const FlatHit hit = meetPlane(flat, placeBefore(flat, origin), direction);
    if (!std::isfinite(hit.distance) || !contains(flat, hit.x, hit.y)) return {};
    return {hit.distance, hit.radiance};
}

}  // namespace woodcock::light
