// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/oracles/surfaces.h"

#include "woodcock/proof/oracles/adding_doubling.h"

namespace woodcock::oracle {

namespace {

/// What of a polygon around the origin is above the plane through it.
std::vector<Vec3d> aboveHorizon(const std::vector<Vec3d>& corners, Vec3d normal) {
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = corners[i], b = corners[(i + 1) % corners.size()];
        const double heightA = dot(a, normal), heightB = dot(b, normal);
        if (heightA >= 0) kept.push_back(a);
        if (heightA * heightB < 0) kept.push_back(a + (b - a) * (heightA / (heightA - heightB)));
    }
    return kept;
}

}  // namespace

double polygonIrradiance(const std::vector<Vec3d>& corners, Vec3d point, Vec3d normal) {
    std::vector<Vec3d> seen;
    for (const Vec3d& c : corners) seen.push_back(c - point);
    seen = aboveHorizon(seen, normal);
    double sum = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const Vec3d a = seen[i], b = seen[(i + 1) % seen.size()], across = cross(a, b);
        const double size = length(across);
        if (size > 0) sum += std::atan2(size, dot(a, b)) * dot(across, normal) / size;
    }
    return std::abs(sum) / 2;
}

double diskIrradiance(double radius, double height, double offset) {
    const double r2 = radius * radius, h2 = height * height, a2 = offset * offset;
    const double x = a2 + h2 - r2, y = std::hypot(x, 2 * radius * height);
    // pi / 2 (1 - x / y), where x may be all but y
    return x > 0 ? 2 * pi * r2 * h2 / (y * (y + x)) : pi / 2 * (1 - x / y);
}

double sphereIrradiance(double radius, double distance, double cosine) {
    const double d = distance / radius, d2 = d * d;
    if (cosine * d >= 1) return pi * cosine / d2;
    if (cosine * d <= -1) return 0;
    const double sine = std::sqrt(1 - cosine * cosine), root = std::sqrt(d2 - 1);
    const double rim = std::acos(std::clamp(-root * cosine / sine, -1.0, 1.0));
    const double cut = std::asin(std::min(1.0, root / (d * sine)));
    return pi / 2 - cut + (cosine * rim - root * std::sqrt(1 - d2 * cosine * cosine)) / d2;
}

double radianceInDielectric(double index) { return index * index; }

double cavityRadiance(double emitted, double albedo) { return emitted / (1 - albedo); }

double cavityRadiance(double emitted, double albedo, int reflections) {
    return cavityRadiance(emitted, albedo) * (1 - std::pow(albedo, reflections + 1));
}

double refractiveHalfSpaceReflectance(double index, double albedo, double g, double mu) {
    constexpr double deep = 1e6;
    return solveSlab({{{deep, albedo, g}}, index}, {mu}).above.reflectance[0];
}

}  // namespace woodcock::oracle
