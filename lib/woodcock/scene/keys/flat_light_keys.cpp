// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "woodcock/light/flat_light.h"
#include "woodcock/scene/keys/light_keys.h"

namespace woodcock::scene {
namespace {

using Rectangle = RectangleDescription;
using Disk = DiskDescription;

/// The place, by a matrix or by position and aim, and what follows from the area.
void checkFlat(const TomlTable& table, FlatDescription& flat, double sizeX, double sizeZ,
               double areaOfOne) {
    const auto position = table.find("position");
    const bool aims = table.has("look_at") || table.has("direction");
    if (position && !aims)
        throw position->error(
            "needs to be told where the light shines; give look_at = [0, 0, 0] (a point that it "
            "shines at) or direction = [0, -1, 0]");
    if (!position)
        for (const char* name : {"look_at", "direction", "roll", "up"})
            if (const auto value = table.find(name))
                throw value->error("needs a position, such as position = [0, 2, 0]");
    if (position) {
        Vec3d direction;
        const Vec3d at = position->vector();
        checkAim(table, at, direction);
        const auto roll = table.find("roll"), up = table.find("up");
        const bool z = up && upAxis().read(*up, {}) == UpAxis::Z;
        flat.worldFromLight =
            lampAxes(direction, z ? UpAxis::Z : UpAxis::Y, roll ? roll->number() : 0);
        flat.worldFromLight.translation = at;
    }
    const auto& [x, y, z] = flat.worldFromLight.column;
    const double skew = std::max({std::abs(dot(normalize(x), normalize(y))),
                                  std::abs(dot(normalize(y), normalize(z))),
                                  std::abs(dot(normalize(z), normalize(x)))});
    const auto matrix = table.find("matrix");
    if (matrix && !(skew < 1e-6))
        throw matrix->error(
            "shears: its axes must be perpendicular, as rectangles stay rectangles and disks disks "
            "or ellipses");
    const double area = areaOfOne * sizeX * sizeZ * length(x) * length(z);
    const auto radiance = table.find("power") ? table.find("power") : table.find("radiance");
    if (table.has("power"))
        flat.radiance = radiance->colour(notNegative) * static_cast<float>(1 / (pi * area));
    const double most = flat.radiance.maximum() * light::Spread(flat.spread).largest();
    if (!(most <= std::numeric_limits<float>::max())) {
        const auto blamed = radiance ? radiance : table.find("spread");
        throw blamed->error(
            "makes more radiance than a float can hold, for an area of {:g} and a spread of {:g}",
            area, flat.spread);
    }
}

void checkRectangle(const TomlTable& table, Rectangle& r) {
    checkFlat(table, r, r.size[0], r.size[1], 1);
}
void checkDisk(const TomlTable& table, Disk& disk) {
    checkFlat(table, disk, disk.radius, disk.radius, pi);
}

template <class Light>
Key<Light> wayOfPlacing(std::string name, std::string doc, std::string type, std::string example,
                        std::string beside) {
    return otherWay<Light>({.name = std::move(name),
                            .doc = std::move(doc),
                            .type = std::move(type),
                            .fallback = "none",
                            .example = std::move(example),
                            .beside = std::move(beside)});
}

template <class Light, class M>
Key<Light> flatKey(KeyInfo info, M FlatDescription::*member, Value<M> value) {
    return key(std::move(info), static_cast<M Light::*>(member), std::move(value));
}

/// `shape`: the keys of its size. `turns`: whether it looks different when it is rolled.
template <class Light>
std::vector<Key<Light>> flatKeys(std::vector<Key<Light>> shape, const std::string& powerDoc,
                                 bool turns) {
    std::vector<Key<Light>> place = placementKeys(
        static_cast<Affine3d Light::*>(&FlatDescription::worldFromLight), "light",
        "`{ translate, rotate, scale }` of a light in y = 0, about the origin, that shines towards "
        "+y");
    place.push_back(wayOfPlacing<Light>("position",
                                        "instead of `transform`: its middle, in world space",
                                        vector().type, "[0, 2, 0]", aimed));
    place.push_back(wayOfPlacing<Light>("direction", "with `position`: where it shines",
                                        vector().type, "[0, 0, 1]", aimed));
    place.push_back(lookAt<Light>(aimedAtAPoint));
    if (turns) {
        place.push_back(wayOfPlacing<Light>(
            "roll",
            "with `position`: degrees by which it is turned about where it shines; at 0 its width "
            "lies level",
            "number", "30", aimed));
        place.push_back(wayOfPlacing<Light>("up", "with `position`: the axis that is upwards",
                                            upAxis().type, "\"z\"", aimed));
    }
    return joined(
        std::move(shape),
        std::vector<Key<Light>>{flatKey<Light>({.name = "radiance",
                                                .doc = "of its surface: its power per area and pi",
                                                .always = true},
                                               &FlatDescription::radiance, colour(notNegative)),
                                power<Light>(powerDoc)},
        place,
        std::vector<Key<Light>>{
            flatKey<Light>(
                {.name = "spread",
                 .doc = "the angle, in degrees from side to side, within which it shines; a "
                        "smaller one makes it brighter along its normal, as its power stays",
                 .comment = "degrees"},
                &FlatDescription::spread, number({1e-3, 180})),
            flatKey<Light>({.name = "two_sided", .doc = "whether its back shines like its front"},
                           &FlatDescription::twoSided, flag()),
            flatKey<Light>({.name = "visible", .doc = "whether the camera sees it"},
                           &FlatDescription::visible, flag())});
}

std::vector<Exclusion> flatExclusions(const std::string& power) {
    const std::string why = "both say where it is";
    return {{"power", "radiance", power},
            {"matrix", "transform", why},
            {"position", "transform", why},
            {"position", "matrix", why},
            aimedTwice()};
}

}  // namespace

template <>
const KeyTable<Rectangle>& keysOf() {
    static const KeyTable<Rectangle> table{
        .id = "light.rectangle",
        .where = "a [[light]] of type rectangle",
        .tag = "rectangle",
        .exclusions = flatExclusions("power = pi x area x radiance"),
        .keys = flatKeys<Rectangle>(
            {key({.name = "size", .doc = "along x and z of its own space", .always = true},
                 &Rectangle::size, numberPair("[width, depth]", positive))},
            "instead of `radiance`: pi area radiance, of each side that shines", true),
        .check = checkRectangle,
        .outer = outerOfLight,
        .path = "light[0]"};
    return table;
}

template <>
const KeyTable<Disk>& keysOf() {
    static const KeyTable<Disk> table{
        .id = "light.disk",
        .where = "a [[light]] of type disk",
        .tag = "disk",
        .exclusions = flatExclusions("power = pi x area x radiance"),
        .keys = flatKeys<Disk>({key({.name = "radius", .doc = "in its own space", .always = true},
                                    &Disk::radius, number(positive))},
                               "instead of `radiance`: pi area radiance, of each side that shines",
                               false),
        .check = checkDisk,
        .outer = outerOfLight,
        .path = "light[0]"};
    return table;
}

}  // namespace woodcock::scene
