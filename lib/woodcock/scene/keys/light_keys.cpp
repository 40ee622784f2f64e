// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using Sun = SunDescription;
using Point = PointDescription;
using Sphere = SphereDescription;
using Environment = EnvironmentDescription;

const std::string outer = "[[surface]]\nsphere = {}\n[[light]]\n";

Value<UpAxis> upAxis() { return choice<UpAxis>("up axis", {{UpAxis::Y, "y"}, {UpAxis::Z, "z"}}); }

/// A key of the sun's place, which is there as soon as one of them is read.
template <class M>
Key<Sun> placeKey(KeyInfo info, M SunPlace::*member, Value<M> value) {
    if (!info.beside) info.beside = "elevation = 40";
    return keyAt<Sun, M>(
        std::move(info),
        [=](auto& sun) {
            if constexpr (!std::is_const_v<std::remove_reference_t<decltype(sun)>>)
                if (!sun.place) sun.place.emplace();
            return sun.place ? &((*sun.place).*member) : nullptr;
        },
        std::move(value));
}

Key<Sun> direction() {
    Key<Sun> k = key(
        {.name = "direction",
         .doc = "the direction in which its light travels. The next three keys may stand instead",
         .fallback = "that or `elevation` must be given",
         .comment = "the way its light travels",
         .always = true},
        &Sun::direction, vector());
    k.write = [write = k.write](const Sun& sun, const SceneWriter& out) {
        return sun.place ? std::nullopt : write(sun, out);
    };
    return k;
}

std::vector<Key<Sun>> sunKeys() {
    return {
        direction(),
        placeKey({.name = "elevation",
                  .doc = "where it stands, in degrees above the horizon",
                  .fallback = "none",
                  .comment = "degrees above the horizon",
                  .always = true},
                 &SunPlace::elevation, number({-90, 90})),
        placeKey({.name = "azimuth",
                  .doc = "where it stands, in degrees clockwise as seen from above: 0 is towards "
                         "-z (with `up = \"z\"`: +y), 90 towards +x",
                  .fallback = "0",
                  .comment = "degrees, clockwise from above",
                  .always = true},
                 &SunPlace::azimuth, number()),
        placeKey({.name = "up",
                  .doc = "the axis that is upwards, for `elevation` and `azimuth`",
                  .fallback = "\"y\""},
                 &SunPlace::up, upAxis()),
        key({.name = "irradiance", .doc = "on a surface that faces it", .always = true},
            &Sun::irradiance, colour(notNegative)),
        key({.name = "angular_diameter",
             .doc = "in degrees. 0 gives parallel rays; the real sun's is 0.53",
             .comment = "degrees"},
            &Sun::angularDiameter, number({0, 90})),
        key({.name = "visible",
             .doc = "whether the camera sees it; needs an `angular_diameter`",
             .beside = "elevation = 40\nangular_diameter = 1"},
            &Sun::visible, flag()),
    };
}

void checkSun(const TomlTable& table, Sun& sun) {
    if (const auto direction = table.find("direction")) {
        const double size = length(sun.direction);
        if (!(size > 0) || !std::isfinite(size))
            throw direction->error("is [{}, {}, {}], which points nowhere", sun.direction.x,
                                   sun.direction.y, sun.direction.z);
    } else if (!table.has("elevation")) {
        throw table.error(
            "is a sun without direction or elevation; give direction = [0, -1, 0] "
            "(the way its light travels) or elevation = 40, azimuth = 120");
    } else {
        sun.direction = sun.place->direction();
    }
    if (sun.visible && sun.angularDiameter == 0)
        throw table.find("visible")->error(
            "is true, but parallel rays cannot be seen; give the sun an "
            "angular_diameter, such as 0.53");
}

void checkPoint(const TomlTable& table, Point& point) {
    if (const auto v = table.find("power"))
        point.intensity = v->colour(notNegative) * static_cast<float>(1 / (4 * pi));
}

void checkSphere(const TomlTable& table, Sphere& sphere) {
    const auto power = table.find("power");
    if (!power) return;
    const double area = 4 * pi * sphere.radius * sphere.radius;
    sphere.radiance = power->colour(notNegative) * static_cast<float>(1 / (pi * area));
    if (!sphere.radiance.isFinite())
        throw power->error("is more radiance than a float can hold, for a radius of {}",
                           sphere.radius);
}

template <class Light>
Key<Light> position(Vec3d Light::*member) {
    return key({.name = "position",
                .doc = "in world space",
                .example = "[0, 2, 0]",
                .required = true,
                .always = true},
               member, vector());
}

template <class Light>
Key<Light> power(std::string doc) {
    return otherWay<Light>({.name = "power",
                            .doc = std::move(doc),
                            .type = colour(notNegative).type,
                            .fallback = "none",
                            .example = "[3, 2, 1]"});
}

}  // namespace

Vec3d SunPlace::direction() const {
    const double e = elevation * pi / 180, a = azimuth * pi / 180;
    const double ahead = std::cos(e) * std::cos(a), right = std::cos(e) * std::sin(a);
    return up == UpAxis::Y ? Vec3d{-right, -std::sin(e), ahead}
                           : Vec3d{-right, -ahead, -std::sin(e)};
}

template <>
const KeyTable<Sun>& keysOf() {
    const std::string why = "both say where the sun stands";
    static const KeyTable<Sun> table{
        .id = "light.sun",
        .where = "a [[light]] of type sun",
        .tag = "sun",
        .exclusions = {{"elevation", "direction", why},
                       {"azimuth", "direction", why},
                       {"up", "direction", "up is for elevation and azimuth"}},
        .keys = sunKeys(),
        .check = checkSun,
        .outer = outer,
        .least = "direction = [0, -1, 0]",
        .path = "light[0]"};
    return table;
}

template <>
const KeyTable<Point>& keysOf() {
    static const KeyTable<Point> table{
        .id = "light.point",
        .where = "a [[light]] of type point",
        .tag = "point",
        .exclusions = {{"power", "intensity", "power = 4 pi x intensity"}},
        .keys = {position(&Point::position),
                 key({.name = "intensity", .doc = "power per solid angle", .always = true},
                     &Point::intensity, colour(notNegative)),
                 power<Point>("instead of `intensity`: 4 pi intensity")},
        .check = checkPoint,
        .outer = outer,
        .least = "position = [1, 1, 1]",
        .path = "light[0]"};
    return table;
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
        .outer = outer,
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
        .keys = {key({.name = "radiance",
                      .doc = "of all directions; with an `image`, what multiplies it",
                      .always = true},
                     &Environment::radiance, colour(notNegative)),
                 key({.name = "image",
                      .doc = "a lat-long image, multiplied by `radiance`. Its centre lies towards "
                             "-z and its top towards +y; with `up = \"z\"`, towards +y and +z"},
                     &Environment::image, path()),
                 key({.name = "rotation",
                      .doc = "of the image about the up axis, in degrees, counter-clockwise as "
                             "seen from above",
                      .comment = "degrees"},
                     &Environment::rotation, number()),
                 key({.name = "up", .doc = "the axis that is upwards, for `image`"},
                     &Environment::up, upAxis()),
                 key({.name = "visible", .doc = "whether the camera sees it"},
                     &Environment::visible, flag())},
        .outer = outer,
        .path = "light[0]"};
    return table;
}

LightDescription readLight(const TomlTable& table, const std::filesystem::path& base) {
    LightDescription light;
    readTagged(table, "light type", light.light, base);
    return light;
}

}  // namespace woodcock::scene
