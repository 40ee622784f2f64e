// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/scene/keys/light_keys.h"

namespace woodcock::scene {
namespace {

using Sun = SunDescription;

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
        .outer = outerOfLight,
        .least = "direction = [0, -1, 0]",
        .path = "light[0]"};
    return table;
}

}  // namespace woodcock::scene
