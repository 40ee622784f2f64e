// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/scene/parse_sections.h"

namespace woodcock {
namespace {

PartialPose parsePartialPose(const TomlTable& table) {
    PartialPose given;
    if (const auto v = table.find("eye")) given.eye = v->vector();
    if (const auto v = table.find("look_at")) given.target = v->vector();
    if (const auto v = table.find("up")) {
        given.up = v->vector();
        if (!(length(*given.up) > 0) || !std::isfinite(length(*given.up)))
            throw v->error("is [{}, {}, {}], which points nowhere", given.up->x, given.up->y,
                           given.up->z);
    }
    return given;
}

LookAt parseLookAt(const TomlTable& table) {
    LookAt pose;
    pose.eye = table.find("eye")->vector();
    const TomlValue target = *table.find("look_at");
    pose.target = target.vector();
    const Vec3d view = pose.target - pose.eye;
    if (!(length(view) > 0) || !std::isfinite(length(view)))
        throw target.error("gives no direction to look in from eye");
    const auto up = table.find("up");
    if (up) pose.up = up->vector();
    const Vec3d right = cross(normalize(view), normalize(pose.up));
    if (!(length(right) > 1e-9)) {
        const std::string message = fmt::format(
            "[{}, {}, {}] is no direction across the view; "
            "give another up, such as [0, 0, 1]",
            pose.up.x, pose.up.y, pose.up.z);
        throw up ? up->error("= {}", message) : target.error("needs an up: {}", message);
    }
    return pose;
}

/// A camera to world matrix, freed of its scale.
Affine3d parsePose(const TomlValue& value) {
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

double fovOf(double sensorHeight, double focalLength) {
    return 2 * std::atan(sensorHeight / (2 * focalLength)) * 180 / pi;
}

double parseFov(const TomlTable& table, double aspect, double otherwise) {
    const std::string why = "the angle follows from the focal length and the sensor";
    for (const char* key : {"focal_length", "sensor_height", "sensor_width"})
        table.exclude(key, "fov", why);
    table.exclude("sensor_width", "sensor_height", "the picture's resolution gives the other");
    if (const auto v = table.find("fov")) return v->number({0, 180, true});
    const auto width = table.find("sensor_width"), height = table.find("sensor_height");
    const auto focal = table.find("focal_length");
    if (!focal && (width || height))
        throw(width ? *width : *height).error("needs a focal_length beside it, in millimetres");
    if (!focal) return otherwise;
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

}  // namespace

CameraDescription parseCamera(const TomlTable& table, double aspect) {
    CameraDescription camera;
    if (const auto type = table.find("type"))
        camera.kind = type->choice("camera type",
                                   std::array<std::string, 2>{"perspective", "orthographic"}) == 0
                          ? CameraDescription::Kind::Perspective
                          : CameraDescription::Kind::Orthographic;
    if (camera.kind == CameraDescription::Kind::Perspective) {
        table.allowOnly({"type", "eye", "look_at", "up", "matrix", "fov", "focal_length",
                         "sensor_height", "sensor_width", "shift", "orbit"},
                        "a perspective [camera]");
        camera.fovY = parseFov(table, aspect, camera.fovY);
    } else {
        table.allowOnly({"type", "eye", "look_at", "up", "matrix", "height", "shift", "orbit"},
                        "an orthographic [camera]");
        if (const auto v = table.find("height")) camera.height = v->number(positive);
    }
    if (const auto v = table.find("shift")) {
        const auto sides = v->elements("[right, up], in heights of the picture", 2);
        camera.shift = {sides[0].number({-1000, 1000}), sides[1].number({-1000, 1000})};
    }
    if (const auto v = table.find("orbit")) camera.orbit = v->number({-1e6, 1e6});
    for (const char* key : {"eye", "look_at", "up"})
        table.exclude(key, "matrix", "the matrix places the camera alone");
    if (const auto v = table.find("matrix"))
        camera.pose = parsePose(*v);
    else if (table.has("eye") && table.has("look_at"))
        camera.pose = parseLookAt(table);
    else
        camera.given = parsePartialPose(table);
    return camera;
}

}  // namespace woodcock
