// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/keys/light_keys.h"

namespace woodcock::scene {
namespace {

using Point = PointDescription;
using Spot = SpotDescription;

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

}  // namespace

template <>
const KeyTable<Point>& keysOf() {
    const std::string profile = "position = [1, 1, 1]\nies = \"a.ies\"";
    static const KeyTable<Point> table{
        .id = "light.point",
        .where = "a [[light]] of type point",
        .tag = "point",
        .exclusions = {{"power", "intensity", "power = 4 pi x intensity"}, aimedTwice()},
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
        .exclusions = {{"power", "intensity", "power = 4 pi x intensity"}, aimedTwice()},
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

}  // namespace woodcock::scene
