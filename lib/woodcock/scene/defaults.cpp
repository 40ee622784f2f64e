// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/defaults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/medium/blackbody.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/choose_camera.h"
#include "woodcock/scene/load_surfaces.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::scene {
namespace {

constexpr double typicalDepth = 10;

/// Median of the line integrals of the field (world units, mean of channels) over a lattice of rays
/// along its three index axes, of those that meet more than wisps. By sums at unit steps or
/// coarser: a choice needs no more. Zero for an empty field.
double typicalIntegral(const grid::Field& field, const Affine3d& worldFromIndex) {
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

/// The brightness at which a fire of this size is seen beside the sun: where it is hottest, a tenth
/// of its size has a radiance of twenty, and where it is half as hot, of one.
std::string glowIntensity(const VolumeDescription& volume, const LoadedVolume& loaded,
                          double hottest) {
    if (!loaded.density) return "";
    const Affine3d world = volume.worldFromObject * loaded.density.objectFromIndex;
    const double size = length(world.box(loaded.density.field->support()).size());
    const double intensity = 200 / (size * double{medium::blackbodyRadiance(hottest).maximum()});
    if (!(intensity > 0) || !std::isfinite(intensity) || intensity > 1e14) return "";
    return fmt::format(", intensity = {}", tomlNumber(roundTo(intensity, magnitude(intensity))));
}

/// A comment in TOML: how what may be fire is lit. Nobody but the user knows how hot it is.
std::string glowHint(const VolumeDescription& volume, const LoadedVolume& loaded, size_t index) {
    if (volume.emission || volume.blackbody) return {};
    constexpr double kelvins = 200;  // what goes beyond is no relative number
    constexpr double flame = 2000;
    const double most = loaded.hottest;
    if (!loaded.temperatures.empty() && most > 0) {
        const bool inKelvins = most >= kelvins;
        const double exact = inKelvins ? 1 : flame / most;
        const double scale = inKelvins ? 1 : roundTo(exact, magnitude(exact) - 1);
        return fmt::format(
            "# '{}' glows with --set 'volume[{}].blackbody={{ scale = {}{} }}':\n# its largest "
            "value, {:.4g}, is {:.0f} K then\n",
            loaded.temperatures, index, tomlNumber(scale),
            glowIntensity(volume, loaded, scale * most), most, scale * most);
    }
    if (!loaded.temperatures.empty())
        return fmt::format(
            "# '{}' glows with --set 'volume[{}].blackbody={{ scale = 2000 }}' where its values go "
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

/// Towards the sun: 40 degrees high, to the camera's left, as light from the side shows form.
SunPlace chooseSun(const SceneDescription& scene, UpAxis up) {
    const Vec3d above = upVector(up);
    Vec3d side = -worldFromCamera(*scene.camera.pose).column[0];
    side = side - above * dot(side, above);
    if (!(length(side) > 1e-6)) side = {-1, 0, 0};
    const double ahead = up == UpAxis::Y ? -side.z : side.y;
    const double azimuth = std::round(std::atan2(side.x, ahead) * 180 / pi);
    return {40, azimuth < 0 ? azimuth + 360 : azimuth, up};
}

std::optional<std::string> chooseLights(SceneDescription& scene, UpAxis up) {
    if (!scene.lights.empty() || anySurfaceEmits(scene)) return std::nullopt;
    SunDescription sun;
    sun.place = chooseSun(scene, up);
    sun.direction = sun.place->direction();
    sun.irradiance = Rgb(5.2f, 4.4f, 3.4f);
    sun.angularDiameter = 0.53;
    EnvironmentDescription sky;
    sky.radiance = Rgb(0.12f, 0.19f, 0.32f);
    scene.lights = changedLights({{sun}, {sky}}, scene.lightChanges);
    std::string text = scene.lightChanges.empty()
                           ? "chosen, a warm sun from the upper left and a blue sky:"
                           : "chosen, a warm sun and a blue sky, changed as --set says:";
    scene.lightChanges.clear();
    for (const LightDescription& light : scene.lights) text += "\n" + writeLight(light);
    return text;
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
    const std::vector<Vec3d> outline = sceneOutline(description, loaded);
    const std::optional<std::string> camera = chooseCamera(description, outline, up);
    const std::optional<std::string> lights = chooseLights(description, up);
    turnCamera(description.camera, outline);  // the lights stay where they are
    if (camera) notes.push_back(*camera + "\n" + writeCamera(description.camera));
    add(lights);
    return notes;
}

}  // namespace woodcock::scene
