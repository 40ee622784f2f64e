// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/sky.h"

#include "woodcock/light/sky_model.h"

namespace woodcock::scene {

SkyParts partsOf(const SkyDescription& sky) {
    const light::SkyModel model({sky.place.elevation, sky.turbidity, sky.groundAlbedo});
    const double sun = sky.sun ? sky.sunStrength : 0;
    // The ground shows what this light sends to it, so a sun that is left out is missed there too.
    const Rgb ground = sky.ground ? light::groundRadiance(model, sky.groundAlbedo, sun) : Rgb(0.0f);
    SkyParts parts;
    parts.image = {light::skyImageWidth, light::skyImageWidth / 2,
                   light::skyImage(model, ground, light::skyImageWidth)};
    parts.environment.radiance = Rgb(static_cast<float>(sky.strength));
    parts.environment.up = sky.place.up;
    parts.environment.rotation = -sky.place.azimuth;  // that one counts counter-clockwise
    parts.environment.visible = sky.visible;
    if (sun > 0) {
        parts.sun.emplace();
        parts.sun->direction = sky.place.direction();
        parts.sun->irradiance = model.sunIrradiance() * static_cast<float>(sky.strength * sun);
        parts.sun->angularDiameter = sky.sunSize;
        parts.sun->visible = sky.visible && sky.sunSize > 0;
    }
    return parts;
}

}  // namespace woodcock::scene
