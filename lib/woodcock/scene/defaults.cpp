// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/defaults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/outline.h"
#include "woodcock/scene/write.h"

namespace woodcock {
namespace {

constexpr double typicalDepth = 10;
constexpr double margin = 0.08;  // of the picture, on every side that is tight

/// `v` to a multiple of 10^exponent.
double roundTo(double v, int exponent) {
    const double power = std::pow(10, std::abs(exponent));
    return exponent < 0 ? std::round(v * power) / power : std::round(v / power) * power;
}
Vec3d roundTo(Vec3d v, int exponent) {
    return {roundTo(v.x, exponent), roundTo(v.y, exponent), roundTo(v.z, exponent)};
}
int magnitude(double v) { return static_cast<int>(std::floor(std::log10(v))); }

/// From a y-up frame to the one whose up axis is `up`; -z becomes +y.
Vec3d withUp(Vec3d v, UpAxis up) { return up == UpAxis::Z ? Vec3d{v.x, 0 - v.z, v.y} : v; }

/// Median of the line integrals of the field (world units, mean of channels) over a lattice of rays
/// along its three index axes, of those that meet more than wisps. By sums at unit steps or
/// coarser: a choice needs no more. Zero for an empty field.
double typicalIntegral(const Field& field, const Affine3d& worldFromIndex) {
    const Box3d box = field.extent();
    if (box.empty()) return 0;
    constexpr int raysPerSide = 24, mostSteps = 512;
    std::vector<double> integrals;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const int steps = std::min(mostSteps, static_cast<int>(std::ceil(box.size()[axis])));
        const double step = box.size()[axis] / steps;
        const double worldStep = step * length(worldFromIndex.column[static_cast<size_t>(axis)]);
        for (int i = 0; i < raysPerSide * raysPerSide; ++i) {
            Vec3d p;
            p[u] = box.lower[u] + box.size()[u] * (i % raysPerSide + 0.5) / raysPerSide;
            p[v] = box.lower[v] + box.size()[v] * (i / raysPerSide + 0.5) / raysPerSide;
            double sum = 0;
            for (int k = 0; k < steps; ++k) {
                p[axis] = box.lower[axis] + (k + 0.5) * step;
                for (int c = 0; c < field.channels(); ++c) sum += field.trilinear(p, c);
            }
            integrals.push_back(sum * worldStep / field.channels());
        }
    }
    const double largest = *std::max_element(integrals.begin(), integrals.end());
    std::erase_if(integrals, [&](double t) { return t <= 0.02 * largest; });
    if (integrals.empty()) return 0;
    const auto middle = integrals.begin() + static_cast<std::ptrdiff_t>(integrals.size() / 2);
    std::nth_element(integrals.begin(), middle, integrals.end());
    return *middle;
}

/// Lines of TOML, and the reason for them.
struct Choice {
    std::string toml, reason;
};

/// The name of the density grid, where it was found by its role.
Choice nameDensity(VolumeDescription& volume, const LoadedVolume& loaded) {
    Choice choice;
    const auto name = [&](std::string& grid, const LoadedField& field) {
        if (!grid.empty()) return;
        grid = field.grid;
        choice = {fmt::format("density = {}\n", tomlText(grid)), ""};
    };
    if (auto* c = std::get_if<DensityCoefficients>(&volume.coefficients)) {
        name(c->density, loaded.density);
    } else if (auto* separate = std::get_if<SeparateCoefficients>(&volume.coefficients)) {
        if (separate->sigmaA) name(separate->sigmaA->grid, loaded.sigmaA);
        if (separate->sigmaS) name(separate->sigmaS->grid, loaded.sigmaS);
    }
    if (volume.emission && loaded.emission) name(volume.emission->grid, loaded.emission);
    return choice;
}

Choice chooseScale(VolumeDescription& volume, const LoadedVolume& loaded) {
    auto* c = std::get_if<DensityCoefficients>(&volume.coefficients);
    if (!c || c->scale) return {};
    const double integral = typicalIntegral(
        *loaded.density.field, volume.worldFromObject * loaded.density.objectFromIndex);
    const double exact = typicalDepth / integral;
    const bool empty = !(integral > 0) || !(exact < std::numeric_limits<float>::max());
    c->scale = empty ? Rgb(1) : Rgb(static_cast<float>(roundTo(exact, magnitude(exact) - 2)));
    return {fmt::format("scale = {}\n", tomlColour(*c->scale)),
            empty ? ", which seems empty (no ray of a bundle through it met any density)"
                  : fmt::format(", so that a typical ray through it has an optical depth of {}",
                                typicalDepth)};
}

/// A comment in TOML: how what may be fire is lit. Nobody but the user knows how bright it is.
std::string glowHint(const VolumeDescription& volume, const LoadedVolume& loaded, size_t index) {
    if (volume.emission || volume.blackbody) return {};
    if (!loaded.temperatures.empty())
        return fmt::format(
            "# '{}' glows with --set 'volume[{}].blackbody={{ scale = 1400 }}' where its values go "
            "up to 1 or so,\n# and with scale = 1 where they are kelvins\n",
            loaded.temperatures, index);
    if (!loaded.flames.empty())
        return fmt::format("# '{0}' glows with --set 'volume[{1}].emission={{ grid = \"{0}\" }}'\n",
                           loaded.flames, index);
    return {};
}

std::optional<std::string> chooseVolume(SceneDescription& scene, const LoadedScene& loaded,
                                        size_t index) {
    VolumeDescription& volume = scene.volumes[index];
    const Choice density = nameDensity(volume, loaded.volumes[index]);
    const Choice scale = chooseScale(volume, loaded.volumes[index]);
    std::string toml = density.toml + scale.toml;
    if (!volume.file.empty() &&
        findPlace(scene.places, fmt::format("volume[{}].file", index)).empty())
        toml = writeVolume(volume) + glowHint(volume, loaded.volumes[index], index);
    if (toml.empty()) return std::nullopt;
    return fmt::format("chosen for volume[{}]{}:\n{}", index, scale.reason, toml);
}

/// What points span along an axis.
struct Extent {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
    void add(double v) { lower = std::min(lower, v), upper = std::max(upper, v); }
    double centre() const { return (lower + upper) / 2; }
};

/// Half the width and height of the picture that are to be filled: at distance 1 (perspective), or
/// of a picture of height 1 (orthographic).
struct HalfPicture {
    double x, y;
    explicit HalfPicture(const SceneDescription& scene) {
        const bool perspective = scene.camera.kind == CameraDescription::Kind::Perspective;
        y = (1 - 2 * margin) * (perspective ? std::tan(scene.camera.fovY * pi / 360) : 0.5);
        x = y * scene.render.width / scene.render.height;
    }
};

/// Where a perspective camera of this picture stands closest with all points in it, in a frame that
/// is turned as the camera is. A point is in it while |p.x - eye.x| <= half.x (eye.z - p.z), and so
/// for y; the tightest points on either side give the planes that meet in the eye.
Vec3d nearestEye(const std::vector<Vec3d>& points, const HalfPicture& half) {
    Extent left, right, below, above;
    for (const Vec3d& p : points) {
        left.add(p.z * half.x - p.x), right.add(p.z * half.x + p.x);
        below.add(p.z * half.y - p.y), above.add(p.z * half.y + p.y);
    }
    return {(right.upper - left.upper) / 2, (above.upper - below.upper) / 2,
            std::max((right.upper + left.upper) / (2 * half.x),
                     (above.upper + below.upper) / (2 * half.y))};
}

/// How far from the origin, on its z axis, such a camera stands closest that looks there.
double nearestDistance(const std::vector<Vec3d>& points, const HalfPicture& half) {
    double distance = 0;
    for (const Vec3d& p : points)
        distance = std::max({distance, p.z + std::abs(p.x) / half.x, p.z + std::abs(p.y) / half.y});
    return distance;
}

/// From the eye that is given.
LookAt lookAtFrom(const SceneDescription& scene, Vec3d target, Vec3d up) {
    const Vec3d eye = *scene.camera.given.eye, view = target - eye;
    const double across = length(cross(normalize(view), normalize(up)));
    if (!(across > 1e-9))
        inPlace(findPlace(scene.places, "camera.eye"), [&] {
            throw inputError(
                "camera.eye looks at the scene's centre, [{:.6g}, {:.6g}, {:.6g}], along up, "
                "[{}, {}, {}], or stands in it; give a look_at or another up",
                target.x, target.y, target.z, up.x, up.y, up.z);
        });
    return {eye, target, up};
}

/// A three-quarter view from slightly above that shows all points, unless what is given of the
/// camera asks for another.
LookAt chooseView(const SceneDescription& scene, const std::vector<Vec3d>& points, UpAxis up) {
    const PartialPose& given = scene.camera.given;
    Box3d bounds;
    for (const Vec3d& p : points) bounds.add(p);
    const double size = length(bounds.size());
    const int grain = magnitude(size) - 3;
    const Vec3d above = given.up.value_or(withUp({0, 1, 0}, up));
    if (given.eye) return lookAtFrom(scene, roundTo(bounds.centre(), grain), above);
    if (given.up) up = std::abs(above.z) > std::abs(above.y) ? UpAxis::Z : UpAxis::Y;
    const Vec3d centre = given.target.value_or(bounds.centre());
    const Affine3d camera = lookAtTransform(withUp({0.55, 0.35, 1}, up), {0, 0, 0}, above);
    std::vector<Vec3d> turned;
    Extent x, y, z;
    for (const Vec3d& p : points) {
        const Vec3d d = p - centre;
        turned.push_back(
            {dot(d, camera.column[0]), dot(d, camera.column[1]), dot(d, camera.column[2])});
        x.add(turned.back().x), y.add(turned.back().y), z.add(turned.back().z);
    }
    Vec3d eye{x.centre(), y.centre(), z.upper + size};
    if (scene.camera.kind == CameraDescription::Kind::Perspective) {
        eye = nearestEye(turned, HalfPicture(scene));
        if (given.target) eye.z = nearestDistance(turned, HalfPicture(scene));
        eye.z = std::max(eye.z, z.upper + 0.2 * size);  // a wide angle would touch the volume
    }
    if (given.target) {
        eye = {0, 0, std::max(eye.z, 0.2 * size)};
        return {roundTo(centre + camera.vector(eye), grain), centre, above};
    }
    return {roundTo(centre + camera.vector(eye), grain),
            roundTo(centre + camera.vector({eye.x, eye.y, z.centre()}), grain), above};
}

/// The height of picture that shows all points from where the camera stands.
double chooseHeight(const SceneDescription& scene, const std::vector<Vec3d>& points) {
    const Affine3d cameraFromWorld = worldFromCamera(*scene.camera.pose).inverse();
    const HalfPicture half(scene);
    double height = 0;
    for (const Vec3d& point : points) {
        const Vec3d p = cameraFromWorld.point(point);
        height = std::max({height, std::abs(p.x) / half.x, std::abs(p.y) / half.y});
    }
    return roundTo(height, magnitude(height) - 2);
}

std::optional<std::string> chooseCamera(SceneDescription& scene, const std::vector<Vec3d>& points,
                                        UpAxis up) {
    CameraDescription& camera = scene.camera;
    const bool fits = camera.height || camera.kind == CameraDescription::Kind::Perspective;
    if (camera.pose && fits) return std::nullopt;
    Box3d bounds;
    for (const Vec3d& p : points) bounds.add(p);
    const Vec3d size = bounds.size();
    if (!(length(size) > 0 && std::isfinite(length(size))))
        throw inputError(
            "no camera can be chosen for what is {:.3g} x {:.3g} x {:.3g} units large; give a "
            "transform that brings it to another scale",
            size.x, size.y, size.z);
    const bool upIsOpen = !camera.pose && !camera.given.up;
    if (!camera.pose) camera.pose = chooseView(scene, points, up);
    camera.given = {};
    if (!fits) camera.height = chooseHeight(scene, points);
    return fmt::format("chosen to frame the {}{}:\n{}",
                       scene.surfaces.empty() ? "volumes" : "scene",
                       !upIsOpen         ? ""
                       : up == UpAxis::Z ? " (up is +z, as in Blender, which wrote them)"
                                         : " (up is +y)",
                       writeCamera(camera));
}

bool anySurfaceEmits(const SceneDescription& scene) {
    for (size_t i = 0; i < scene.surfaces.size(); ++i)
        if (natureOf(scene, i).emits) return true;
    return false;
}

std::optional<std::string> chooseLights(SceneDescription& scene, UpAxis up) {
    if (!scene.lights.empty() || anySurfaceEmits(scene)) return std::nullopt;
    // From the camera's left: light from the side shows form.
    const Vec3d above = withUp({0, 1, 0}, up);
    Vec3d side = -worldFromCamera(*scene.camera.pose).column[0];
    side = side - above * dot(side, above);
    side = length(side) > 1e-6 ? normalize(side) : withUp({-1, 0, 0}, up);
    constexpr double elevation = 40 * pi / 180;
    SunDescription sun;
    sun.direction = roundTo(-(side * std::cos(elevation) + above * std::sin(elevation)), -2);
    sun.irradiance = Rgb(5.2f, 4.4f, 3.4f);
    sun.angularDiameter = 0.53;
    EnvironmentDescription sky;
    sky.radiance = Rgb(0.12f, 0.19f, 0.32f);
    scene.lights = {{sun}, {sky}};
    return fmt::format("chosen, a warm sun from the upper left and a blue sky:\n{}\n{}",
                       writeLight(scene.lights[0]), writeLight(scene.lights[1]));
}

UpAxis upOf(const SceneDescription& scene, const LoadedScene& loaded) {
    bool anyFile = false;
    for (size_t i = 0; i < scene.volumes.size(); ++i) {
        if (scene.volumes[i].file.empty()) continue;
        if (loaded.volumes[i].up == UpAxis::Y) return UpAxis::Y;
        anyFile = true;
    }
    return anyFile ? UpAxis::Z : UpAxis::Y;
}

}  // namespace

std::string defaultSceneText(const std::vector<std::filesystem::path>& vdbFiles) {
    std::string text;
    for (const std::filesystem::path& file : vdbFiles)
        text += fmt::format("[[volume]]\nfile = {}\ng = 0.6\n", tomlText(escapePath(file)));
    return text;
}

std::vector<std::string> completeScene(SceneDescription& description, const LoadedScene& loaded) {
    std::vector<std::string> notes;
    const auto add = [&](std::optional<std::string> note) {
        if (note) notes.push_back(std::move(*note));
    };
    for (size_t i = 0; i < description.volumes.size(); ++i)
        add(chooseVolume(description, loaded, i));
    const UpAxis up = upOf(description, loaded);
    add(chooseCamera(description, sceneOutline(description, loaded), up));
    add(chooseLights(description, up));
    return notes;
}

}  // namespace woodcock
