// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "commands.h"
#include "interrupt.h"
#include "log.h"
#include "progress.h"
#include "render_options.h"
#include "stats.h"
#include "woodcock/base/error.h"
#include "woodcock/image/outputs.h"
#include "woodcock/image/whole_file.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/parse.h"
#include "woodcock/scene/write.h"

namespace woodcock::tool {

namespace {

constexpr int interruptedCode = 130;

SceneDescription parseInput(const RenderOptions& options,
                            const std::vector<std::string>& overrides) {
    if (options.inputIsScene()) return parseScene(options.inputs.front(), overrides);
    const std::string name = "command line";
    SceneDescription scene = parseSceneText(defaultSceneText(options.inputs), name, "", overrides);
    std::erase_if(scene.places, [&](const auto& place) { return place.second.starts_with(name); });
    return scene;
}

Storage storageOf(const std::string& name) {
    return name == "half" ? Storage::Half : name == "float" ? Storage::Float : Storage::Auto;
}

/// The size goes through the scene file, where cameras depend on it.
SceneDescription parseAtSize(const RenderOptions& options) {
    if (!options.size) return parseInput(options, options.overrides);
    const int width = options.size->width;
    int height = options.size->height.value_or(0);
    if (height == 0) {
        const RenderDescription own = parseInput(options, options.overrides).render;
        height = std::max(1, static_cast<int>(std::lround(double(width) * own.height / own.width)));
    }
    std::vector<std::string> overrides = options.overrides;
    overrides.push_back(fmt::format("render.resolution=[{}, {}]", width, height));
    return parseInput(options, overrides);
}

SceneDescription describeScene(const RenderOptions& options) {
    SceneDescription scene = parseAtSize(options);
    for (VolumeDescription& volume : scene.volumes) {
        if (options.storage) volume.storage = storageOf(*options.storage);
        volume.repair |= options.repair;
    }
    RenderDescription& render = scene.render;
    render.spp = options.spp.value_or(render.spp);
    render.seed = options.seed.value_or(render.seed);
    render.timeLimit = options.timeLimit.value_or(render.timeLimit);
    render.noise = options.noise.value_or(render.noise);

    OutputDescription& output = scene.output;
    if (!options.outputs.empty()) output.files = options.outputs;
    if (!options.layers.empty()) output.layers = options.layers;
    output.half |= options.half;
    output.display = options.display.value_or(output.display);
    output.view = options.view.value_or(output.view);
    output.look = options.look.value_or(output.look);
    output.exposure = options.exposure.value_or(output.exposure);
    if (!options.ocio.empty()) scene.ocio = options.ocio;
    return scene;
}

bool environmentIsHidden(const SceneDescription& scene) {
    bool hidden = !scene.lights.empty();  // lights that are left to the program: a visible sky
    for (const LightDescription& light : scene.lights)
        if (const auto* environment = std::get_if<EnvironmentDescription>(&light.light))
            hidden &= !environment->visible;
    return hidden;
}

Outputs prepareOutputs(const SceneDescription& scene, const RenderOptions& options) {
    OutputSettings settings;
    settings.files = scene.output.files;
    settings.half = scene.output.half;
    settings.layers = layersFromNames(scene.output.layers);
    settings.display = {scene.output.display, scene.output.view, scene.output.look,
                        scene.output.exposure};
    settings.ocio = scene.ocio;
    settings.withAlpha = environmentIsHidden(scene);
    for (const std::filesystem::path& file : {options.stats, options.writeScene})
        if (!file.empty()) checkWritable(file);
    return Outputs(std::move(settings));
}

RenderSettings renderSettings(const SceneDescription& scene, const RenderOptions& options) {
    const RenderDescription& render = scene.render;
    RenderSettings settings;
    settings.width = render.width;
    settings.height = render.height;
    if (options.crop) {
        const PixelRectangle& p = *options.crop;
        if (p.x1 > render.width || p.y1 > render.height)
            throw usageError("--crop {},{},{},{} reaches beyond the image of {}x{} pixels", p.x0,
                             p.y0, p.x1, p.y1, render.width, render.height);
        settings.crop = Film::Window{p.x0, p.y0, p.x1, p.y1};
    }
    const SampleRange samples = options.samples.value_or(SampleRange{0, render.spp});
    settings.firstSample = samples.first;
    settings.endSample = samples.end;
    settings.seed = render.seed;
    settings.maxScatterings = render.maxScatterings;
    settings.threads = options.threads.value_or(0);
    settings.timeLimit = render.timeLimit;
    settings.noise = render.noise;
    const ExrLayers layers = layersFromNames(scene.output.layers);
    settings.depthLayers = layers.depth || layers.transmittance;
    return settings;
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(text.data());
    writeWholeFile(file, {bytes, text.size()});
}

/// Loads what the scene names and fills in what it leaves open.
LoadedScene load(SceneDescription& description) {
    LoadedScene loaded = loadScene(description);
    for (const std::string& note : loaded.notes) spdlog::warn("{}", note);
    for (const std::string& choice : completeScene(description, loaded)) spdlog::info("{}", choice);
    return loaded;
}

RenderResult renderWithProgress(const Scene& scene, const RenderSettings& settings,
                                ProgressStyle style) {
    spdlog::info("{}", findNeeds(scene).describe());
    Progress progress(style);
    progress.start(settings);
    RenderResult result = render(scene, settings, [&](const RenderProgress& now) {
        progress.update(now);
        return !interrupted();
    });
    progress.finish(result);
    spdlog::info("{} in {}: samples {}:{} of each pixel, noise {:.2f} %",
                 stopReasonName(result.reason), formatDuration(result.seconds),
                 settings.firstSample, result.endSample, 100 * result.film.noise());
    if (const std::uint64_t count = result.film.nonFiniteCount())
        spdlog::warn("{} samples were not finite and are left out", count);
    return result;
}

void run(const RenderOptions& options, const std::string& commandLine) {
    const ProgressStyle style =
        options.quiet ? ProgressStyle::None : progressStyle(options.progress);
    setUpLog(style == ProgressStyle::Json ? LogStyle::Json : LogStyle::Text,
             options.quiet ? "warning" : options.logLevel.value_or("info"));
    options.check();
    catchInterrupts();

    SceneDescription description = describeScene(options);
    const std::vector<std::filesystem::path>& files = description.output.files;
    if (files.empty() && options.writeScene.empty())
        throw usageError("there is no output; name a file with -o, such as -o smoke.exr");
    const RenderSettings settings = renderSettings(description, options);
    const Outputs outputs = prepareOutputs(description, options);
    if (!outputs.note().empty()) spdlog::warn("{}", outputs.note());

    const auto loadStart = std::chrono::steady_clock::now();
    LoadedScene loaded = load(description);
    if (!options.writeScene.empty())
        writeTextFile(options.writeScene,
                      writeScene(description, options.writeScene.parent_path()));
    if (files.empty()) return;
    const Scene scene = buildScene(description, std::move(loaded));
    const std::chrono::duration<double> loading = std::chrono::steady_clock::now() - loadStart;
    if (interrupted()) throw CLI::RuntimeError(interruptedCode);

    const RenderResult result = renderWithProgress(scene, settings, style);
    const std::string digest = sceneDigest(description);
    if (result.film.mostSamples() > 0) {
        outputs.write(result.film, {settings.firstSample, result.endSample, settings.seed,
                                    result.seconds, digest, commandLine});
        for (const std::filesystem::path& file : files) spdlog::info("wrote {}", file.string());
    } else {
        spdlog::warn("interrupted before anything was rendered: nothing is written");
    }
    if (!options.stats.empty())
        writeTextFile(options.stats, statsText(result, settings, digest, loading.count()));
    if (result.reason == StopReason::Interrupted) throw CLI::RuntimeError(interruptedCode);
}

}  // namespace

CLI::App& addRenderCommand(CLI::App& app, const std::string& commandLine) {
    CLI::App& command = *app.add_subcommand("render", "Render a scene or a volume to images");
    const auto options = std::make_shared<RenderOptions>();
    options->addTo(command);
    command.callback([options, commandLine] { run(*options, commandLine); });
    return command;
}

}  // namespace woodcock::tool
