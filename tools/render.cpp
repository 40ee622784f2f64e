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
#include "quality_auto.h"
#include "render_options.h"
#include "scene_input.h"
#include "stats.h"
#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/precision.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_files.h"
#include "woodcock/scene/write.h"

namespace woodcock::tool {

namespace {

constexpr int interruptedCode = 130;

SceneDescription describeScene(const RenderOptions& options) {
    SceneDescription scene = parseInput(options.sceneInput());
    for (VolumeDescription& volume : scene.volumes) {
        if (options.storage) volume.storage = *options.storage;
        volume.repair |= options.repair;
    }
    RenderDescription& render = scene.render;
    render.spp = options.spp.value_or(render.spp);
    render.seed = options.seed.value_or(render.seed);
    render.timeLimit = options.timeLimit.value_or(render.timeLimit);
    render.noise = options.noise.value_or(render.noise);
    if (options.adaptive) render.adaptive = options.adaptive;

    OutputDescription& output = scene.output;
    if (!options.outputs.empty()) {
        output.files = options.outputs;
        std::erase_if(scene.places,
                      [](const auto& place) { return place.first.starts_with("output.files"); });
    }
    if (!options.layers.empty()) output.layers = options.layers;
    output.half |= options.half;
    const auto replaceName = [&](const char* key, std::string& name, const auto& option) {
        if (!option) return;
        name = *option;
        scene.places[fmt::format("output.{}", key)] = fmt::format("--{}", key);
    };
    replaceName("display", output.display, options.display);
    replaceName("view", output.view, options.view);
    replaceName("look", output.look, options.look);
    output.exposure = options.exposure.value_or(output.exposure);
    if (!options.ocio.empty()) {
        scene.ocio = options.ocio;
        scene.places["ocio"] = "--ocio";
    }
    return scene;
}

bool environmentIsHidden(const SceneDescription& scene) {
    bool hidden = !scene.lights.empty();  // lights that are left to the program: a visible sky
    for (const LightDescription& light : scene.lights)
        if (const auto* environment = std::get_if<EnvironmentDescription>(&light.light))
            hidden &= !environment->visible;
    return hidden;
}

bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code missing;
    return a.lexically_normal() == b.lexically_normal() ||
           std::filesystem::equivalent(a, b, missing);
}

/// Nothing that is read may be written over, and nothing that is written may be written twice.
void checkFiles(SceneDescription scene, const RenderOptions& options) {
    std::vector<std::filesystem::path> read = options.inputs, written;
    for (const std::filesystem::path* file : sceneFiles(scene)) read.push_back(*file);
    read.push_back(scene.ocio);
    if (options.rendersImages()) written = scene.output.files;
    for (const std::filesystem::path& file : {options.stats, options.writeScene})
        if (!file.empty()) written.push_back(file);
    for (auto file = written.begin(); file != written.end(); ++file) {
        const auto isThis = [&](const auto& other) { return sameFile(*file, other); };
        if (std::any_of(read.begin(), read.end(), isThis))
            throw usageError("'{}' is an input and an output", file->string());
        if (std::any_of(written.begin(), file, isThis))
            throw usageError("'{}' is named twice as an output", file->string());
    }
}

/// Those of a scene file are known to be right.
ExrLayers layersOf(const SceneDescription& scene) {
    return inPlace("--layers", [&] { return layersFromNames(scene.output.layers); });
}

bool isStdout(const std::filesystem::path& file) { return file == "-"; }

/// Where the name that a message of ColorConfig begins with was given: "scene.toml:9:8: ".
std::string placeOfDisplayError(const SceneDescription& scene, std::string_view message) {
    for (const std::string key : {"display", "view", "look"}) {
        const std::string place = findPlace(scene.places, "output." + key);
        if (message.starts_with(key + " '") && !place.empty()) return place + ": ";
    }
    return "";
}

Outputs prepareOutputs(const SceneDescription& scene, const RenderOptions& options) {
    const auto check = [](const std::string& place, const std::filesystem::path& file) {
        if (!file.empty() && !isStdout(file)) inPlace(place, [&] { checkWritable(file); });
    };
    check("--stats", options.stats);
    check("--write-scene", options.writeScene);
    ColorConfig colour =
        inPlace(findPlace(scene.places, "ocio"), [&] { return ColorConfig(scene.ocio); });
    OutputSettings settings{.colour = std::move(colour)};
    if (options.rendersImages()) settings.files = scene.output.files;
    for (std::size_t i = 0; i < settings.files.size(); ++i)
        inPlace(findPlace(scene.places, fmt::format("output.files[{}]", i)),
                [&] { checkWritable(settings.files[i]); });
    settings.half = scene.output.half;
    settings.layers = layersOf(scene);
    settings.display = {scene.output.display, scene.output.view, scene.output.look,
                        scene.output.exposure};
    settings.withAlpha = environmentIsHidden(scene);
    try {
        return Outputs(std::move(settings));
    } catch (const Error& e) {
        throw Error(e.kind(), placeOfDisplayError(scene, e.what()) + e.what());
    }
}

/// Throws where the image's sums cannot be held, before anything is loaded.
void checkMemory(const RenderSettings& settings, const SceneDescription& scene) {
    const auto crop = settings.crop.value_or(Film::Window{0, 0, settings.width, settings.height});
    constexpr double encoded = 32;  // bytes of a pixel in an image file with all layers, about
    const double kept = double(sizeof(Film::Pixel)) +
                        (settings.featureLayers ? double(sizeof(Film::FeaturePixel)) : 0) +
                        (environmentIsHidden(scene) ? 0 : double(sizeof(Film::ForegroundPixel)));
    const double needed = double(crop.width()) * crop.height() * (kept + encoded);
    const auto possible = static_cast<double>(memoryLimit());
    if (needed <= possible) return;
    const double share = std::sqrt(possible / needed);
    const std::string place = findPlace(scene.places, "render.resolution");
    throw Error(
        place == "--res" ? ErrorKind::Usage : ErrorKind::Input,
        fmt::format("{}{}{} x {} pixels need {} of memory, and there are {}; {:.0f} x {:.0f} "
                    "is possible, or parts of the image by --crop",
                    place, place.empty() ? "" : ": ", crop.width(), crop.height(),
                    formatGiB(needed), formatGiB(possible), std::floor(crop.width() * share),
                    std::floor(crop.height() * share)));
}

RenderSettings renderSettings(const SceneDescription& scene, const RenderOptions& options) {
    const RenderDescription& render = scene.render;
    RenderSettings settings = woodcock::renderSettings(render);
    if (options.crop) {
        const PixelRectangle& p = *options.crop;
        if (p.x1 > render.width || p.y1 > render.height)
            throw usageError("--crop {},{},{},{} reaches beyond the image of {}x{} pixels", p.x0,
                             p.y0, p.x1, p.y1, render.width, render.height);
        settings.crop = Film::Window{p.x0, p.y0, p.x1, p.y1};
    }
    if (settings.adaptive && options.samples)
        throw usageError(
            "{} and --samples contradict each other: how many samples a pixel gets follows from "
            "its first ones; give --spp{}",
            options.adaptive ? "--adaptive" : "the scene's adaptive sampling",
            options.adaptive ? "" : ", or --set render.adaptive=false");
    const SampleRange samples = options.samples.value_or(SampleRange{0, render.spp});
    settings.firstSample = samples.first;
    settings.endSample = samples.end;
    settings.threads = options.threads.value_or(0);
    const ExrLayers layers = layersOf(scene);
    settings.depthLayers = layers.depth || layers.transmittance;
    settings.featureLayers = layers.albedo || layers.normal;
    checkMemory(settings, scene);
    return settings;
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    if (isStdout(file)) {
        fmt::print("{}", text);
        if (std::fflush(stdout) != 0) throw failure("cannot write to stdout");
        return;
    }
    const auto* const bytes = reinterpret_cast<const unsigned char*>(text.data());
    writeWholeFile(file, {bytes, text.size()});
}

bool haveSameFields(const SceneDescription& a, const SceneDescription& b) {
    const RenderDescription &ra = a.render, &rb = b.render;
    return a.volumes == b.volumes && ra.storage == rb.storage && ra.lookup == rb.lookup &&
           ra.levelOfDetail == rb.levelOfDetail;
}

std::string samplesText(const RenderResult& result, const RenderSettings& settings) {
    if (!settings.adaptive)
        return fmt::format("samples {}:{} of each pixel", settings.firstSample, result.endSample);
    const Film& film = result.film;
    return fmt::format("the work of {} samples per pixel, {} to {} of them, {:.3g} in the mean",
                       result.endSample, film.fewestSamples(), film.mostSamples(),
                       film.meanSamples());
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
    spdlog::info("{} in {}: {}, {}", stopReasonName(result.reason), formatDuration(result.seconds),
                 samplesText(result, settings), noiseText(result.film.noise()));
    if (const std::uint64_t count = result.counters.clamped)
        spdlog::info("{} of {} paths were clamped to a radiance of {:g}", count,
                     result.counters.paths, settings.approximations.clamp);
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
    if (files.empty() && options.rendersImages())
        throw usageError("there is no output; name a file with -o, such as -o smoke.exr");
    if (options.rendersImages()) options.checkFor(files);
    checkFiles(description, options);
    RenderSettings settings = renderSettings(description, options);
    const Outputs outputs = prepareOutputs(description, options);
    if (!outputs.note().empty()) spdlog::warn("{}", outputs.note());

    const auto loadStart = std::chrono::steady_clock::now();
    LoadedScene loaded = loadAndComplete(description);
    if (!options.writeScene.empty())
        writeTextFile(options.writeScene,
                      writeScene(description, options.writeScene.parent_path()));
    if (!options.rendersImages()) return;
    if (options.choosesQuality()) {
        const SceneDescription before = description;
        if (!chooseQuality(description, options, commandLine))
            throw CLI::RuntimeError(interruptedCode);
        if (!haveSameFields(before, description)) loaded = loadScene(description);
        settings = renderSettings(description, options);
    }
    std::vector<std::string> notes;
    const Scene scene = buildScene(description, std::move(loaded), &notes);
    for (const std::string& note : notes) spdlog::info("{}", note);
    const std::chrono::duration<double> loading = std::chrono::steady_clock::now() - loadStart;
    if (interrupted()) throw CLI::RuntimeError(interruptedCode);
    for (const std::string& warning : precisionWarnings(scene)) spdlog::warn("{}", warning);

    const RenderResult result = renderWithProgress(scene, settings, style);
    const std::string digest = sceneDigest(description);
    if (result.film.mostSamples() > 0) {
        outputs.write(result.film, {settings.firstSample, result.endSample, settings.seed,
                                    result.seconds, digest, commandLine, settings.adaptive});
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
