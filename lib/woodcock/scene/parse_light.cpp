// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/scene/parse_sections.h"

namespace woodcock {
namespace {

UpAxis parseUp(const TomlTable& table) {
    const auto up = table.find("up");
    return up && up->choice("up axis", std::array<std::string, 2>{"y", "z"}) == 1 ? UpAxis::Z
                                                                                  : UpAxis::Y;
}

/// The direction, and the place that it comes from, where that is given.
void parseDirection(const TomlTable& table, SunDescription& sun) {
    const std::string why = "both say where the sun stands";
    table.exclude("elevation", "direction", why);
    table.exclude("azimuth", "direction", why);
    table.exclude("up", "direction", "up is for elevation and azimuth");
    if (const auto direction = table.find("direction")) {
        sun.direction = direction->vector();
        const double size = length(sun.direction);
        if (!(size > 0) || !std::isfinite(size))
            throw direction->error("is [{}, {}, {}], which points nowhere", sun.direction.x,
                                   sun.direction.y, sun.direction.z);
        return;
    }
    const auto elevation = table.find("elevation");
    if (!elevation)
        throw table.error(
            "is a sun without direction or elevation; give direction = [0, -1, 0] "
            "(the way its light travels) or elevation = 40, azimuth = 120");
    const auto azimuth = table.find("azimuth");
    sun.place =
        SunPlace{elevation->number({-90, 90}), azimuth ? azimuth->number() : 0, parseUp(table)};
    sun.direction = sun.place->direction();
}

SunDescription parseSun(const TomlTable& table) {
    table.allowOnly({"type", "direction", "elevation", "azimuth", "up", "irradiance",
                     "angular_diameter", "visible"},
                    "a [[light]] of type sun");
    SunDescription sun;
    parseDirection(table, sun);
    if (const auto v = table.find("irradiance")) sun.irradiance = v->colour(notNegative);
    if (const auto v = table.find("angular_diameter")) sun.angularDiameter = v->number({0, 90});
    if (const auto v = table.find("visible")) {
        sun.visible = v->flag();
        if (sun.visible && sun.angularDiameter == 0)
            throw v->error(
                "is true, but parallel rays cannot be seen; give the sun an "
                "angular_diameter, such as 0.53");
    }
    return sun;
}

EnvironmentDescription parseEnvironment(const TomlTable& table, const std::filesystem::path& base) {
    table.allowOnly({"type", "radiance", "image", "rotation", "up", "visible"},
                    "a [[light]] of type environment");
    EnvironmentDescription environment;
    if (const auto v = table.find("radiance")) environment.radiance = v->colour(notNegative);
    if (const auto v = table.find("image")) environment.image = v->path(base);
    if (const auto v = table.find("rotation")) environment.rotation = v->number();
    if (const auto v = table.find("visible")) environment.visible = v->flag();
    environment.up = parseUp(table);
    return environment;
}

PointDescription parsePoint(const TomlTable& table) {
    table.allowOnly({"type", "position", "intensity", "power"}, "a [[light]] of type point");
    table.exclude("power", "intensity", "power = 4 pi x intensity");
    PointDescription point;
    point.position = table.need("position", "position = [0, 2, 0]").vector();
    if (const auto v = table.find("intensity")) point.intensity = v->colour(notNegative);
    if (const auto v = table.find("power"))
        point.intensity = v->colour(notNegative) * static_cast<float>(1 / (4 * pi));
    return point;
}

SphereDescription parseSphere(const TomlTable& table) {
    table.allowOnly({"type", "position", "radius", "radiance", "power", "visible"},
                    "a [[light]] of type sphere");
    table.exclude("power", "radiance", "power = 4 pi^2 radius^2 x radiance");
    SphereDescription sphere;
    sphere.position = table.need("position", "position = [0, 2, 0]").vector();
    sphere.radius = table.need("radius", "radius = 0.1").number(positive);
    if (const auto v = table.find("radiance")) sphere.radiance = v->colour(notNegative);
    if (const auto v = table.find("power")) {
        const double area = 4 * pi * sphere.radius * sphere.radius;
        sphere.radiance = v->colour(notNegative) * static_cast<float>(1 / (pi * area));
        if (!sphere.radiance.isFinite())
            throw v->error("is more radiance than a float can hold, for a radius of {}",
                           sphere.radius);
    }
    if (const auto v = table.find("visible")) sphere.visible = v->flag();
    return sphere;
}

}  // namespace

Vec3d SunPlace::direction() const {
    const double e = elevation * pi / 180, a = azimuth * pi / 180;
    const double ahead = std::cos(e) * std::cos(a), right = std::cos(e) * std::sin(a);
    return up == UpAxis::Y ? Vec3d{-right, -std::sin(e), ahead}
                           : Vec3d{-right, -ahead, -std::sin(e)};
}

LightDescription parseLight(const TomlTable& table, const std::filesystem::path& base) {
    const std::array<std::string, 4> types{"sun", "point", "sphere", "environment"};
    LightDescription light;
    switch (table.need("type", "type = \"sun\"").choice("light type", types)) {
        case 0:
            light.light = parseSun(table);
            break;
        case 1:
            light.light = parsePoint(table);
            break;
        case 2:
            light.light = parseSphere(table);
            break;
        default:
            light.light = parseEnvironment(table, base);
            break;
    }
    return light;
}

}  // namespace woodcock
