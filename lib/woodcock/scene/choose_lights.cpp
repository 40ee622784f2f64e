// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/choose_lights.h"

#include <cmath>

#include "woodcock/scene/choose_camera.h"

namespace woodcock::scene {
namespace {

/// Towards the sun: to the camera's left, and by so many degrees on the camera's side.
SunPlace placeSun(const Affine3d& worldFromCamera, UpAxis up, double nearer) {
    const Vec3d above = upVector(up);
    Vec3d side = -worldFromCamera.column[0];
    side = side - above * dot(side, above);
    if (!(length(side) > 1e-6)) side = {-1, 0, 0};
    const double ahead = up == UpAxis::Y ? -side.z : side.y;
    const double azimuth = std::round(std::atan2(side.x, ahead) * 180 / pi - nearer);
    return {40, std::fmod(azimuth + 360, 360), up};
}

SunDescription sunAt(SunPlace place, Rgb irradiance) {
    SunDescription sun;
    sun.place = place;
    sun.direction = place.direction();
    sun.irradiance = irradiance;
    sun.angularDiameter = 0.53;
    return sun;
}

EnvironmentDescription backdrop(UpAxis up) {
    EnvironmentDescription dark;
    dark.radiance = Rgb(0.075f, 0.088f, 0.11f);
    dark.above = Rgb(0.01f, 0.013f, 0.02f);
    dark.below = Rgb(0.008f, 0.009f, 0.012f);
    dark.up = up;
    return dark;
}

}  // namespace

std::vector<LightDescription> chosenLights(const Affine3d& worldFromCamera, UpAxis up, Look look,
                                           bool glows) {
    const SunPlace place = placeSun(worldFromCamera, up, look == Look::Plain ? 0 : 5);
    if (look == Look::Plain)
        return {{sunAt(place, Rgb(5.2f, 4.4f, 3.4f))},
                {EnvironmentDescription{.radiance = Rgb(0.12f, 0.19f, 0.32f)}}};
    EnvironmentDescription fill;
    fill.radiance = glows ? Rgb(0.06f, 0.08f, 0.12f) : Rgb(0.07f, 0.09f, 0.13f);
    fill.visible = false;
    return {{sunAt(place, glows ? Rgb(4.5f, 3.8f, 3.0f) : Rgb(9.6f, 8.1f, 6.3f))},
            {backdrop(up)},
            {fill}};
}

}  // namespace woodcock::scene
