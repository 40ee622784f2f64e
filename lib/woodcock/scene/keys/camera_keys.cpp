// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using C = CameraDescription;
using Base = const std::filesystem::path&;

/// A camera to world matrix, freed of its scale.
Affine3d readPose(const TomlValue& value, Base) {
    Affine3d pose = value.affine();
    const double size = std::cbrt(std::abs(pose.determinant()));
    constexpr double tolerance = 1e-4;  // of matrices that were written in single precision
    for (size_t i = 0; i < 3; ++i) {
        const Vec3d a = pose.column[i] / size, b = pose.column[(i + 1) % 3] / size;
        if (std::abs(length(a) - 1) > tolerance || std::abs(dot(a, b)) > tolerance)
            throw value.error(
                "is sheared or scaled unevenly; a camera's axes must be orthogonal "
                "and equally long");
    }
    if (pose.determinant() < 0)
        throw value.error("mirrors the picture (its determinant is negative)");
    if (std::abs(size - 1) > 1e-12)
        for (Vec3d& axis : pose.column) axis = axis / size;
    return pose;
}

/// Eye, target or up: of a pose that is given in full, or of a part of one. They are read as parts
/// and become a pose when all are known.
Key<C> poseKey(KeyInfo info, Vec3d LookAt::*full, std::optional<Vec3d> PartialPose::*part) {
    info.example = "[1, 2, 0.5]";
    info.beside = "up = [0, 0, 1]";
    Key<C> k = key(std::move(info), &C::given, part, vector());
    k.write = [=, write = k.write](const C& c, const SceneWriter& out) -> std::optional<Written> {
        if (!c.pose) return write(c, out);
        const auto* pose = std::get_if<LookAt>(&*c.pose);
        return pose ? std::optional(Written{tomlVector(pose->*full)}) : std::nullopt;
    };
    return k;
}

Key<C> matrixKey() {
    Key<C> key;
    key.info = {.name = "matrix",
                .doc =
                    "instead of these three: world from camera, which looks along -z with +y up. "
                    "It must not shear. Its scale is ignored",
                .type = matrix().type,
                .fallback = "none",
                .comment = "world from camera, which looks along -z",
                .moves = true,
                .examples = matrix().examples};
    key.read = [](const TomlValue& v, C& c, Base base) { c.pose = readPose(v, base); };
    key.write = [](const C& c, const SceneWriter&) -> std::optional<Written> {
        const auto* pose = c.pose ? std::get_if<Affine3d>(&*c.pose) : nullptr;
        if (!pose) return std::nullopt;
        return Written{tomlMatrix(*pose), "world from camera, which looks along -z"};
    };
    return key;
}

camera::Shutter readShutter(const TomlValue& value, Base) {
    constexpr double longest = 1000;  // frames
    if (!value.isArray()) {
        const double length = value.number({0, longest});
        return {-length / 2, length / 2};
    }
    const auto times = value.elements("[open, close], in frames", 2);
    const camera::Shutter shutter{times[0].number({-longest, longest}),
                                  times[1].number({-longest, longest})};
    if (shutter.length() < 0)
        throw value.error("closes at {}, before it opens at {}; give [open, close]", shutter.close,
                          shutter.open);
    return shutter;
}

Key<C> shutterKey() {
    return key({.name = "shutter",
                .doc = "for how many frames light is collected, around the frame of the picture: "
                       "0.5 is a shutter of 180 degrees. Or when it opens and closes, in frames "
                       "after that frame. 0: a sharp picture of one moment. See \"Motion blur\"",
                .comment = "frames after the frame of the picture: opens, closes"},
               &C::shutter,
               Value<camera::Shutter>{"number >= 0, or `[open, close]`",
                                      {"[-0.5, 0.25]", "0.5"},
                                      readShutter,
                                      [](const camera::Shutter& s, const SceneWriter&) {
                                          if (s == camera::Shutter{}) return std::string("0");
                                          return fmt::format("[{}, {}]", tomlNumber(s.open),
                                                             tomlNumber(s.close));
                                      }});
}

/// The keys of cameras of one kind alone.
Key<C> only(C::Kind kind, Key<C> key) {
    key.belongs = [=](const C& c) { return c.kind == kind; };
    return key;
}

std::vector<Key<C>> lensKeys() {
    const std::string instead = "perspective: instead of `fov`, in millimetres; ";
    const auto other = [&](std::string name, const std::string& needs, std::string beside) {
        return only(C::Kind::Perspective, otherWay<C>({.name = std::move(name),
                                                       .doc = instead + needs,
                                                       .type = number(positive).type,
                                                       .fallback = "none",
                                                       .example = "30",
                                                       .beside = std::move(beside)}));
    };
    return {
        only(C::Kind::Orthographic, key({.name = "height",
                                         .doc = "orthographic: world units from bottom to top",
                                         .fallback = "*chosen* to frame the volumes and surfaces",
                                         .comment = "world units, bottom to top",
                                         .beside = "type = \"orthographic\""},
                                        &C::height, number(positive))),
        only(C::Kind::Perspective,
             key({.name = "fov",
                  .doc = "perspective: degrees from the picture's bottom to its top",
                  .comment = "degrees, bottom to top",
                  .always = true},
                 &C::fovY, number({0, 180, true}))),
        other("focal_length", "needs one of the next two", "focal_length = 50\nsensor_height = 24"),
        other("sensor_height", "needs `focal_length`", "focal_length = 50\nsensor_height = 24"),
        other("sensor_width", "needs `focal_length`", "focal_length = 50\nsensor_width = 36"),
    };
}

std::vector<Key<C>> placeKeys() {
    return {
        key({.name = "shift",
             .doc = "moves the film by so many heights of the picture. The camera does not turn, "
                    "so verticals stay upright",
             .comment = "of the film, in heights of the picture: right, up"},
            &C::shift,
            [] {
                Value<std::array<double, 2>> shift = numberPair("[right, up]", {-1000, 1000});
                shift.read = [](const TomlValue& v, Base) {
                    const auto sides = v.elements("[right, up], in heights of the picture", 2);
                    return std::array{sides[0].number({-1000, 1000}),
                                      sides[1].number({-1000, 1000})};
                };
                return shift;
            }()),
        atRest(key(
            {.name = "orbit",
             .doc = "turns the camera to its right by so many degrees, about the up axis, around "
                    "what it looks at (with a `matrix`: around the middle of the scene). Lights "
                    "stay. A camera that is *chosen* then keeps one distance for all angles, from "
                    "which every side fits. `render --orbit DEGREES` does the same. A scene that "
                    "is saved has the turned camera",
             .comment = "degrees to its right, around what it sees"},
            &C::orbit, number({-1e6, 1e6}))),
        poseKey({.name = "eye",
                 .doc = "position; without it, it is *chosen*",
                 .fallback = "*chosen* to frame the volumes and surfaces"},
                &LookAt::eye, &PartialPose::eye),
        poseKey({.name = "look_at",
                 .doc = "position; without it, it is *chosen*",
                 .fallback = "*chosen* to frame the volumes and surfaces"},
                &LookAt::target, &PartialPose::target),
        poseKey({.name = "up",
                 .doc = "the direction that is upwards in the picture",
                 .fallback = "`[0, 1, 0]`; where eye or look_at is chosen for volumes that Blender "
                             "wrote, `[0, 0, 1]`"},
                &LookAt::up, &PartialPose::up),
        matrixKey(),
        shutterKey(),
    };
}

std::vector<Exclusion> exclusions() {
    const std::string why = "the angle follows from the focal length and the sensor";
    const std::string alone = "the matrix places the camera alone";
    return {{"focal_length", "fov", why},
            {"sensor_height", "fov", why},
            {"sensor_width", "fov", why},
            {"sensor_width", "sensor_height", "the picture's resolution gives the other"},
            {"eye", "matrix", alone},
            {"look_at", "matrix", alone},
            {"up", "matrix", alone}};
}

double fovOf(double sensorHeight, double focalLength) {
    return 2 * std::atan(sensorHeight / (2 * focalLength)) * 180 / pi;
}

/// The angle of a focal length and a sensor; nothing where there are none.
std::optional<double> fovOfSensor(const TomlTable& table, double aspect) {
    const auto width = table.find("sensor_width"), height = table.find("sensor_height");
    const auto focal = table.find("focal_length");
    if (!focal && (width || height))
        throw(width ? *width : *height).error("needs a focal_length beside it, in millimetres");
    if (!focal) return std::nullopt;
    if (!width && !height)
        throw focal->error("needs a sensor_height or sensor_width beside it, in millimetres");
    const double sensorHeight =
        height ? height->number(positive) : width->number(positive) / aspect;
    const double fov = fovOf(sensorHeight, focal->number(positive));
    if (!(fov > 0 && fov < 180))
        throw focal->error(
            "and the sensor give a field of view of {} degrees; it must lie "
            "strictly between 0 and 180",
            fov);
    return fov;
}

void checkUp(const TomlTable& table, const PartialPose& given) {
    if (!given.up || (length(*given.up) > 0 && std::isfinite(length(*given.up)))) return;
    throw table.find("up")->error("is [{}, {}, {}], which points nowhere", given.up->x, given.up->y,
                                  given.up->z);
}

/// An eye and a target, and an up or its default.
LookAt fullPose(const TomlTable& table, const PartialPose& given) {
    LookAt pose{*given.eye, *given.target};
    if (given.up) pose.up = *given.up;
    const TomlValue target = *table.find("look_at");
    const Vec3d view = pose.target - pose.eye;
    if (!(length(view) > 0) || !std::isfinite(length(view)))
        throw target.error("gives no direction to look in from eye");
    const Vec3d right = cross(normalize(view), normalize(pose.up));
    if (!(length(right) > 1e-9)) {
        const std::string message = fmt::format(
            "[{}, {}, {}] is no direction across the view; "
            "give another up, such as [0, 0, 1]",
            pose.up.x, pose.up.y, pose.up.z);
        const auto up = table.find("up");
        throw up ? up->error("= {}", message) : target.error("needs an up: {}", message);
    }
    return pose;
}

void checkPose(const TomlTable& table, C& camera) {
    if (camera.given.eye && camera.given.target) {
        camera.pose = fullPose(table, camera.given);
        camera.given = {};
    } else {
        checkUp(table, camera.given);
    }
}

}  // namespace

template <>
const KeyTable<C>& keysOf() {
    static const KeyTable<C> table{
        .id = "camera",
        .exclusions = exclusions(),
        .keys = joined(std::vector{key({.name = "type"}, &C::kind,
                                       choice<C::Kind>("camera type",
                                                       {{C::Kind::Perspective, "perspective"},
                                                        {C::Kind::Orthographic, "orthographic"}}))},
                       lensKeys(), placeKeys()),
        .check = checkPose,
        .outer = "[[surface]]\nsphere = {}\n[camera]\n",
        .path = "camera"};
    return table;
}

CameraDescription readCamera(const TomlTable& table, double aspect) {
    CameraDescription camera;
    const Key<C>& type = keysOf<C>().keys.front();
    if (const auto v = table.find(type.info.name)) type.read(*v, camera, {});
    allowKeys(table, camera,
              camera.kind == C::Kind::Perspective ? "a perspective [camera]"
                                                  : "an orthographic [camera]");
    readAllowed(table, camera, {});
    if (const auto fov = fovOfSensor(table, aspect)) camera.fovY = *fov;
    return camera;
}

}  // namespace woodcock::scene
