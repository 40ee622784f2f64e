// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/light/flat_light.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using Sun = SunDescription;
using Point = PointDescription;
using Sphere = SphereDescription;
using Environment = EnvironmentDescription;
using Spot = SpotDescription;
using Rectangle = RectangleDescription;
using Disk = DiskDescription;

const std::string outerOfLight = "[[surface]]\nsphere = {}\n[[light]]\n";

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

// ---- keys that say where a lamp shines --------------------------------------------------------

const Exclusion aimedTwice{"look_at", "direction", "both say where it shines"};

/// Reads `look_at`, and makes sure that the direction points somewhere.
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

template <class Light>
Key<Light> lookAt(std::string beside) {
    return otherWay<Light>({.name = "look_at",
                            .doc = "instead of `direction`: a point that it shines at",
                            .type = vector().type,
                            .fallback = "none",
                            .example = "[0, 0, 0]",
                            .beside = std::move(beside)});
}

const std::string aimed = "position = [1, 1, 1]\ndirection = [1, 0, 0]",
                  aimedAtAPoint = "position = [1, 1, 1]\nlook_at = [0, 5, 0]";

template <class Light>
Key<Light> power(std::string doc) {
    return otherWay<Light>({.name = "power",
                            .doc = std::move(doc),
                            .type = colour(notNegative).type,
                            .fallback = "none",
                            .example = "[3, 2, 1]"});
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

// ---- points and spots -------------------------------------------------------------------------

template <class Light>
void readPointPower(const TomlTable& table, Light& light) {
    if (const auto v = table.find("power"))
        light.intensity = v->colour(notNegative) * static_cast<float>(1 / (4 * pi));
}

void checkPoint(const TomlTable& table, Point& point) {
    readPointPower(table, point);
    if (point.ies.empty())
        for (const char* name : {"look_at", "direction", "up", "roll"})
            if (const auto value = table.find(name))
                throw value->error("turns a photometric file, and the light has none; give ies");
    checkAim(table, point.position, point.direction);
}

void checkSpot(const TomlTable& table, Spot& spot) {
    readPointPower(table, spot);
    if (!table.has("look_at") && !table.has("direction"))
        throw table.error(
            "is a spot without look_at or direction; give look_at = [0, 0, 0] (a point that it "
            "shines at) or direction = [0, -1, 0]");
    checkAim(table, spot.position, spot.direction);
}

// ---- rectangles and disks ---------------------------------------------------------------------

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
            aimedTwice};
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

}  // namespace

Vec3d SunPlace::direction() const {
    const double e = elevation * pi / 180, a = azimuth * pi / 180;
    const double ahead = std::cos(e) * std::cos(a), right = std::cos(e) * std::sin(a);
    return up == UpAxis::Y ? Vec3d{-right, -std::sin(e), ahead}
                           : Vec3d{-right, -ahead, -std::sin(e)};
}

Affine3d lampAxes(Vec3d direction, UpAxis up, double roll) {
    const Vec3d y = normalize(direction);
    const Vec3d level = cross(up == UpAxis::Y ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, y);
    const Vec3d x = length(level) > 1e-9 ? normalize(level) : Vec3d{1, 0, 0};
    const Affine3d axes{{x, y, cross(x, y)}, {}};
    return axes * Affine3d::rotate(1, roll);
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

template <>
const KeyTable<Point>& keysOf() {
    const std::string profile = "position = [1, 1, 1]\nies = \"a.ies\"";
    static const KeyTable<Point> table{
        .id = "light.point",
        .where = "a [[light]] of type point",
        .tag = "point",
        .exclusions = {{"power", "intensity", "power = 4 pi x intensity"}, aimedTwice},
        .keys =
            {position(&Point::position),
             key({.name = "intensity", .doc = "power per solid angle", .always = true},
                 &Point::intensity, colour(notNegative)),
             power<Point>("instead of `intensity`: 4 pi intensity"),
             key({.name = "ies",
                  .doc = "a photometric file (IES, LM-63, type C). It multiplies `intensity` "
                         "by 4 pi / 177.83 of its candela"},
                 &Point::ies, path()),
             key({.name = "direction",
                  .doc = "with `ies`: where the file's vertical angle 0 points",
                  .beside = profile},
                 &Point::direction, vector()),
             lookAt<Point>(profile + "\nlook_at = [0, 5, 0]"),
             key({.name = "roll",
                  .doc = "with `ies`: degrees by which the file is turned about that direction; "
                         "at 0 its horizontal angles 90 and 270 lie level",
                  .comment = "degrees",
                  .beside = profile},
                 &Point::roll, number()),
             key({.name = "up", .doc = "with `ies`: the axis that is upwards", .beside = profile},
                 &Point::up, upAxis())},
        .check = checkPoint,
        .outer = outerOfLight,
        .least = "position = [1, 1, 1]",
        .path = "light[0]"};
    return table;
}

template <>
const KeyTable<Spot>& keysOf() {
    static const KeyTable<Spot> table{
        .id = "light.spot",
        .where = "a [[light]] of type spot",
        .tag = "spot",
        .exclusions = {{"power", "intensity", "power = 4 pi x intensity"}, aimedTwice},
        .keys = {position(&Spot::position),
                 key({.name = "direction",
                      .doc = "the axis of its cone",
                      .fallback = "that or `look_at` must be given",
                      .always = true},
                     &Spot::direction, vector()),
                 lookAt<Spot>(aimedAtAPoint),
                 key({.name = "intensity",
                      .doc = "power per solid angle, along the axis",
                      .always = true},
                     &Spot::intensity, colour(notNegative)),
                 power<Spot>("instead of `intensity`: 4 pi intensity, the power of a point that is "
                             "as bright"),
                 key({.name = "cone",
                      .doc = "the angle of its cone, in degrees from edge to edge",
                      .comment = "degrees"},
                     &Spot::cone, number({1e-3, 180})),
                 key({.name = "blend",
                      .doc = "how soft the edge is: 0 is hard, 1 begins at the axis"},
                     &Spot::blend, number(zeroToOne))},
        .check = checkSpot,
        .outer = outerOfLight,
        .least = aimed,
        .path = "light[0]"};
    return table;
}

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

LightDescription readLight(const TomlTable& table, const std::filesystem::path& base) {
    LightDescription light;
    readTagged(table, "light type", light.light, base);
    return light;
}

}  // namespace woodcock::scene
