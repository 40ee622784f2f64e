// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/keys/light_keys.h"

#include <cmath>

namespace woodcock::scene {
namespace {

using Sphere = SphereDescription;
using Environment = EnvironmentDescription;

void checkSphere(const TomlTable& table, Sphere& sphere) {
    const auto power = table.find("power");
    if (!power) return;
    const double area = 4 * pi * sphere.radius * sphere.radius;
    sphere.radiance = power->colour(notNegative) * static_cast<float>(1 / (pi * area));
    if (!sphere.radiance.isFinite())
        throw power->error("is more radiance than a float can hold, for a radius of {}",
                           sphere.radius);
}

}  // namespace

Value<UpAxis> upAxis() { return choice<UpAxis>("up axis", {{UpAxis::Y, "y"}, {UpAxis::Z, "z"}}); }

void checkAim(const TomlTable& table, Vec3d position, Vec3d& direction) {
    if (const auto target = table.find("look_at")) {
        direction = target->vector() - position;
        const double size = length(direction);
        if (!(size > 0) || !std::isfinite(size))
            throw target->error("is the light's own position, [{}, {}, {}], so it points nowhere",
                                position.x, position.y, position.z);
    } else if (const auto value = table.find("direction")) {
        direction = value->vector();
        const double size = length(direction);
        if (!(size > 0) || !std::isfinite(size))
            throw value->error("is [{}, {}, {}], which points nowhere", direction.x, direction.y,
                               direction.z);
    }
}

Affine3d lampAxes(Vec3d direction, UpAxis up, double roll) {
    const Vec3d y = normalize(direction);
    const Vec3d level = cross(up == UpAxis::Y ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, y);
    const Vec3d x = length(level) > 1e-9 ? normalize(level) : Vec3d{1, 0, 0};
    const Affine3d axes{{x, y, cross(x, y)}, {}};
    return axes * Affine3d::rotate(1, roll);
}

template <>
const KeyTable<Sphere>& keysOf() {
    static const KeyTable<Sphere> table{
        .id = "light.sphere",
        .where = "a [[light]] of type sphere",
        .tag = "sphere",
        .exclusions = {{"power", "radiance", "power = 4 pi^2 radius^2 x radiance"}},
        .keys = {position(&Sphere::position),
                 key({.name = "radius",
                      .doc = "in world units",
                      .example = "0.1",
                      .required = true,
                      .always = true},
                     &Sphere::radius, number(positive)),
                 key({.name = "radiance", .doc = "of its surface", .always = true},
                     &Sphere::radiance, colour(notNegative)),
                 power<Sphere>("instead of `radiance`: 4 pi^2 radius^2 radiance"),
                 key({.name = "visible", .doc = "whether the camera sees it"}, &Sphere::visible,
                     flag())},
        .check = checkSphere,
        .outer = outerOfLight,
        .least = "position = [1, 1, 1]\nradius = 2",
        .path = "light[0]"};
    return table;
}

template <>
const KeyTable<Environment>& keysOf() {
    static const KeyTable<Environment> table{
        .id = "light.environment",
        .where = "a [[light]] of type environment",
        .tag = "environment",
        .exclusions = {{"above", "image", "an image says what is above"},
                       {"below", "image", "an image says what is below"}},
        .keys = {key({.name = "radiance",
                      .doc = "of all directions; with an `image`, what multiplies it",
                      .always = true},
                     &Environment::radiance, colour(notNegative)),
                 key({.name = "above",
                      .doc = "straight up, where that differs: `radiance` is then the horizon's, "
                             "and fades towards it as a bell, half of which is 12 degrees high",
                      .fallback = "`radiance`"},
                     &Environment::above, colour(notNegative)),
                 key({.name = "below", .doc = "the same, straight down", .fallback = "`radiance`"},
                     &Environment::below, colour(notNegative)),
                 key({.name = "image",
                      .doc = "a lat-long image, multiplied by `radiance`. Its centre lies towards "
                             "-z and its top towards +y; with `up = \"z\"`, towards +y and +z"},
                     &Environment::image, path()),
                 key({.name = "rotation",
                      .doc = "of the image about the up axis, in degrees, counter-clockwise as "
                             "seen from above",
                      .comment = "degrees"},
                     &Environment::rotation, number()),
                 key({.name = "up",
                      .doc = "the axis that is upwards, for `image`, `above` and `below`"},
                     &Environment::up, upAxis()),
                 key({.name = "visible", .doc = "whether the camera sees it"},
                     &Environment::visible, flag())},
        .outer = outerOfLight,
        .path = "light[0]"};
    return table;
}

template <>
const KeyTable<LightDescription>& keysOf() {
    static const KeyTable<LightDescription> table{
        .id = "light",
        .keys = {key(
            {.name = "group", .doc = "the light group that it counts to; see \"Light groups\""},
            &LightDescription::group, groupName())},
        .outer = std::string(outerOfLight) + "type = \"environment\"\n",
        .path = "light[0]"};
    return table;
}

LightDescription readLight(const TomlTable& table, const std::filesystem::path& base) {
    LightDescription light;
    std::vector<std::string> ofAllTypes;
    addNames(light, ofAllTypes);
    readTagged(table, "light type", light.light, base, ofAllTypes);
    readAllowed(table, light, base);
    return light;
}

}  // namespace woodcock::scene
