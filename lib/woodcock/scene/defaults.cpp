// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/defaults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/choose_camera.h"
#include "woodcock/scene/choose_glow.h"
#include "woodcock/scene/choose_lights.h"
#include "woodcock/scene/load_surfaces.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::scene {
namespace {

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

Choice chooseScale(VolumeDescription& volume, const LoadedVolume& loaded, double depth) {
    auto* c = std::get_if<DensityCoefficients>(&volume.coefficients);
    if (!c || c->scale) return {};
    const double integral = typicalIntegral(
        *loaded.density.field, volume.worldFromObject * loaded.density.objectFromIndex);
    const double exact = depth / integral;
    const bool empty = !(integral > 0) || !(exact < std::numeric_limits<float>::max());
    c->scale = empty ? Rgb(1) : Rgb(static_cast<float>(roundTo(exact, magnitude(exact) - 2)));
    return {fmt::format("scale = {}\n", tomlColour(*c->scale)),
            empty ? ", which seems empty (no ray of a bundle through it met any density)"
                  : fmt::format(", so that a typical ray through it has an optical depth of {}",
                                depth)};
}

/// A grid of colours is the albedo of a volume of no scene file. Returns why, or why not, in a part
/// of a sentence; empty: there is none.
std::string chooseColour(SceneDescription& scene, const LoadedVolume& loaded, size_t index) {
    VolumeDescription& volume = scene.volumes[index];
    auto* c = std::get_if<DensityCoefficients>(&volume.coefficients);
    const bool given =
        !findPlace(scene.places, fmt::format("volume[{}].file", index)).empty() ||
        !findPlace(scene.places, fmt::format("volume[{}].albedo_grid", index)).empty();
    if (!c || given || volume.file.empty() || !loaded.density || !(loaded.palest > 0) ||
        loaded.colours == loaded.density.grid)
        return {};
    if (loaded.palest > 1 && !volume.repair)
        return fmt::format(
            "its '{}' is not used: it holds values up to {:.4g}, and an albedo lies between 0 and "
            "1 (--repair sets them to 1)",
            loaded.colours, loaded.palest);
    c->albedoGrid = loaded.colours;
    return fmt::format("its '{}' colours it", loaded.colours);
}

std::optional<std::string> chooseVolume(SceneDescription& scene, const LoadedScene& loaded,
                                        size_t index, Look look) {
    VolumeDescription& volume = scene.volumes[index];
    const Choice density = nameDensity(volume, loaded.volumes[index]);
    std::string reasons;
    if (look == Look::Picture)
        for (const std::string& reason : {chooseGlow(scene, loaded.volumes[index], index),
                                          chooseColour(scene, loaded.volumes[index], index)})
            if (!reason.empty()) reasons += "; " + reason;
    const Choice scale = chooseScale(volume, loaded.volumes[index], typicalDepth(look));
    std::string toml = density.toml + scale.toml;
    if (!volume.file.empty() &&
        findPlace(scene.places, fmt::format("volume[{}].file", index)).empty())
        toml = writeVolume(volume);
    if (toml.empty()) return std::nullopt;
    return fmt::format("chosen for volume[{}]{}{}:\n{}", index, scale.reason, reasons, toml);
}

std::optional<std::string> chooseLights(SceneDescription& scene, UpAxis up, Look look) {
    if (!scene.lights.empty() || anySurfaceEmits(scene)) return std::nullopt;
    const bool glows = anyVolumeOrSurfaceGlows(scene);
    scene.lights = changedLights(chosenLights(worldFromCamera(*scene.camera.pose), up, look, glows),
                                 scene.lightChanges);
    std::string text = fmt::format(
        "chosen, a {} from the left{}", glows && look == Look::Picture ? "dim sun" : "warm sun",
        look == Look::Plain ? " and a blue sky" : ", a dark backdrop, and a fill that is not seen");
    text += scene.lightChanges.empty() ? ":" : ", changed as --set says:";
    scene.lightChanges.clear();
    for (const LightDescription& light : scene.lights) text += "\n" + writeLight(light);
    return text;
}

/// The coefficients of a file that holds no density, but grids that bear their names; else empty,
/// also where the file cannot be read, which loadScene() tells.
std::string coefficientLines(const std::filesystem::path& path) {
    grid::VdbFile file;
    try {
        file = grid::listGrids(path);
    } catch (const Error&) {
        return {};
    }
    if (grid::hasRole(file, grid::GridRole::Density)) return {};
    std::string lines;
    for (const char* name : {"sigma_a", "sigma_s"})
        for (const grid::GridListing& grid : file.grids)
            if (grid.uniqueName == name && grid.usable() && grid.channels > 0)
                lines += fmt::format("{0} = {{ grid = \"{0}\" }}\n", name);
    return lines;
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

double typicalDepth(Look look) { return look == Look::Plain ? 10 : 20; }

std::string defaultSceneText(const std::vector<std::filesystem::path>& vdbFiles, Look look) {
    std::string text;
    for (const std::filesystem::path& file : vdbFiles) {
        const std::string coefficients = coefficientLines(file);
        text += fmt::format("[[volume]]\nfile = {}\n{}", tomlText(escapePath(file)), coefficients);
        if (look == Look::Plain)
            text += "g = 0.6\n";
        else if (coefficients.empty())
            text += "albedo = 0.97\n";
    }
    return text;
}

std::vector<std::string> completeScene(SceneDescription& description, const LoadedScene& loaded,
                                       Look look) {
    std::vector<std::string> notes;
    const auto add = [&](std::optional<std::string> note) {
        if (note) notes.push_back(std::move(*note));
    };
    for (size_t i = 0; i < description.volumes.size(); ++i)
        add(chooseVolume(description, loaded, i, look));
    const UpAxis up = upOf(description, loaded);
    const Vec3d view = usualView(up, look);
    const bool seenFromThere = !description.camera.pose && !description.camera.given.eye &&
                               !description.camera.given.up && !description.camera.orbit;
    const std::vector<Vec3d> outline = look == Look::Picture && seenFromThere
                                           ? seenOutline(description, loaded, view)
                                           : sceneOutline(description, loaded);
    const std::optional<std::string> camera = chooseCamera(description, outline, up, view);
    const std::optional<std::string> lights = chooseLights(description, up, look);
    turnCamera(description.camera, outline);  // the lights stay where they are
    if (camera) notes.push_back(*camera + "\n" + writeCamera(description.camera));
    add(lights);
    return notes;
}

}  // namespace woodcock::scene
