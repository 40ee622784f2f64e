// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/preview.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "tools/common/interrupt.h"
#include "woodcock/base/error.h"
#include "woodcock/base/path_variables.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

image::Outputs previewOutputs(const std::filesystem::path& picture) {
    image::ColorConfig colour("");
    image::OutputSettings settings{.colour = std::move(colour)};
    settings.files = {picture};
    return image::Outputs(std::move(settings));
}

/// A low sun from the left of where the camera is put, and a dark sky, against which both sides of
/// a cloud stand out.
constexpr const char* lights = R"(
[[light]]
type = "sun"
elevation = 32
azimuth = 235
irradiance = [7.0, 6.1, 4.9]
angular_diameter = 0.53

[[light]]
type = "environment"
radiance = [0.07, 0.11, 0.19]
)";

std::string quoted(const grid::GridListing& grid) { return tomlText(grid.uniqueName); }

/// The largest value that was baked.
double greatestOf(const bake::Bake& bake, const grid::GridListing& grid) {
    for (const bake::BakedGridStatistics& statistics : bake.statistics)
        if (statistics.name == grid.name) return statistics.greatest;
    return 0;
}

/// Fire, whose brightest voxels shine some times brighter than lit smoke through their own depth.
std::string fireLines(const grid::VdbFile& file, const bake::Bake& bake, double length) {
    constexpr double hot = 2000, radiance = 2, depths = 20;  // kelvins; depths across the whole
    if (grid::hasRole(file, grid::GridRole::Temperature)) {
        const grid::GridListing grid = grid::findGrid(file, grid::GridRole::Temperature).grid;
        const double greatest = greatestOf(bake, grid);
        if (!(greatest > 0)) return "";
        const double kelvins = greatest > 100 ? 1 : hot / greatest;
        const double emitted = 1e-6 * 5.670374e-8 * std::pow(hot, 4) / pi;  // at intensity 1
        return fmt::format("blackbody = {{ temperature = {}, scale = {}, intensity = {} }}\n",
                           quoted(grid), tomlNumber(kelvins),
                           tomlNumber(radiance * depths / length / emitted));
    }
    if (grid::hasRole(file, grid::GridRole::Emission)) {
        const grid::GridListing grid = grid::findGrid(file, grid::GridRole::Emission).grid;
        const double greatest = greatestOf(bake, grid);
        if (!(greatest > 0)) return "";
        const double each = radiance * depths / length / greatest;
        return fmt::format("emission = {{ grid = {}, scale = [{}, {}, {}] }}\n", quoted(grid),
                           tomlNumber(each), tomlNumber(0.38 * each), tomlNumber(0.08 * each));
    }
    return "";
}

std::string sceneOfGrids(const bake::Recipe& recipe, const bake::Bake& bake,
                         const std::filesystem::path& volume) {
    const grid::VdbFile file = grid::listGrids(volume);
    const auto has = [&](std::string_view name) {
        return std::any_of(file.grids.begin(), file.grids.end(),
                           [&](const grid::GridListing& grid) { return grid.name == name; });
    };
    std::string text = fmt::format("[[volume]]\nfile = {}\n", tomlText(escapePath(volume)));
    if (has("sigma_a") || has("sigma_s")) {
        for (const char* name : {"sigma_a", "sigma_s"})
            if (has(name)) text += fmt::format("{0} = {{ grid = \"{0}\" }}\n", name);
    } else {
        const Vec3d size = recipe.bounds.size();
        const std::string fire = fireLines(file, bake, std::max({size.x, size.y, size.z}));
        // Bright smoke would hold the fire's light until it comes out white.
        const std::string albedo = fire.empty() ? "albedo = 0.98\n" : "albedo = 0.5\n";
        text += grid::hasRole(file, grid::GridRole::Colour)
                    ? fmt::format("albedo_grid = {}\n",
                                  quoted(grid::findGrid(file, grid::GridRole::Colour).grid))
                    : albedo;
        text += "g = 0.4\n" + fire;
    }
    return text + lights;
}

scene::SceneDescription describe(const bake::Recipe& recipe, const std::string& text,
                                 const PreviewSettings& settings) {
    const std::filesystem::path directory = std::filesystem::path(recipe.name).parent_path();
    const auto parse = [&] {
        return scene::parseSceneText(
            text, "preview", recipe.preview.empty() ? "" : directory,
            {fmt::format("render.resolution=[{}, {}]", settings.width, settings.height),
             "render.quality=draft"});
    };
    return recipe.preview.empty() ? parse() : scene::inPlace(recipe.previewPlace, parse);
}

std::string ownScene(const bake::Recipe& recipe, const std::filesystem::path& volume) {
    std::string text = recipe.preview;
    const std::string_view name = bake::previewVolume;
    const std::string quotedPath = tomlText(escapePath(std::filesystem::absolute(volume)));
    const std::string path = quotedPath.substr(1, quotedPath.size() - 2);  // it stands in quotes
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += path.size())
        text.replace(at, name.size(), path);
    return text;
}

}  // namespace

std::string previewScene(const bake::Recipe& recipe, const bake::Bake& bake,
                         const std::filesystem::path& volume) {
    return recipe.preview.empty() ? sceneOfGrids(recipe, bake, volume) : ownScene(recipe, volume);
}

void checkPreview(const std::filesystem::path& picture, const bake::Recipe& recipe) {
    previewOutputs(picture);
    if (!recipe.preview.empty()) describe(recipe, ownScene(recipe, "preview.vdb"), {});
}

std::optional<image::Film> renderPreview(const bake::Recipe& recipe, const bake::Bake& bake,
                                         const std::filesystem::path& volume,
                                         const PreviewSettings& previewSettings,
                                         ProgressStyle style) {
    scene::SceneDescription description =
        describe(recipe, previewScene(recipe, bake, volume), previewSettings);
    scene::LoadedScene loaded = scene::loadScene(description);
    for (const std::string& note : loaded.notes) spdlog::warn("{}", note);
    for (const std::string& choice : scene::completeScene(description, loaded))
        spdlog::debug("preview: {}", choice);
    const render::Scene scene = scene::buildScene(description, std::move(loaded));

    render::RenderSettings settings = scene::renderSettings(description.render);
    settings.firstSample = 0;
    settings.endSample = 256;
    settings.timeLimit = previewSettings.seconds;
    settings.threads = previewSettings.threads;
    render::RenderResult result = renderWithProgress(scene, settings, style);
    if (result.film.mostSamples() == 0) return std::nullopt;
    spdlog::debug("preview: {} samples a pixel in {:.2f} s", result.endSample, result.seconds);
    return std::move(result.film);
}

bool writePreview(const bake::Recipe& recipe, const bake::Bake& bake,
                  const std::filesystem::path& volume, const std::filesystem::path& picture,
                  const PreviewSettings& settings, ProgressStyle style) {
    const image::Outputs outputs = previewOutputs(picture);
    const std::optional<image::Film> film = renderPreview(recipe, bake, volume, settings, style);
    if (film) {
        outputs.write(*film, {});
        spdlog::info("wrote {}", picture.string());
    }
    return !interrupted();
}

}  // namespace woodcock::tool
