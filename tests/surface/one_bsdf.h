// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/surface/bsdf.h"

namespace woodcock::test {

/// A point whose normal is +z.
inline surface::BsdfPoint flatPoint(double iorOutside = 1, double iorInside = 1) {
    return {{0, 0, 1}, {0, 0, 1}, 0, 0, iorOutside, iorInside};
}

inline surface::Bsdf bsdfOf(const surface::Material& material,
                            const surface::BsdfPoint& point = flatPoint()) {
    return surface::Bsdf(std::vector<surface::Material>{material}, 0, point);
}

inline surface::Material diffuse(float albedo) { return surface::DiffuseMaterial{Rgb(albedo)}; }
inline surface::Material whiteMetal(double roughness) {
    surface::ConductorMaterial metal;
    metal.fresnelColour = Rgb(1.0f);
    metal.roughness = roughness;
    return metal;
}
inline surface::Material glass(double roughness) {
    return surface::DielectricMaterial{1.5, roughness};
}

/// A unit vector at this cosine to +z.
inline Vec3d at(double cosine, double phi) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

inline std::array<double, 3> three(RandomStream& random) {
    return {random.uniform(), random.uniform(), random.uniform()};
}

}  // namespace woodcock::test
