// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/frames.h"
#include "tools/common/interrupt.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/common/progress.h"
#include "tools/common/scene_input.h"
#include "tools/common/stats.h"
#include "tools/render/choices_text.h"
#include "tools/render/options.h"
#include "tools/render/picture_warnings.h"
#include "tools/render/quality_auto.h"
#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/image_format.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/needs.h"
#include "woodcock/render/precision.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_files.h"
#include "woodcock/scene/seen_light.h"
#include "woodcock/scene/write.h"

namespace woodcock::tool {

namespace {

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

bool isStdout(const std::filesystem::path& file) { return file == "-"; }

/// Nothing that is read may be written over, and nothing that is written may be written twice.
void checkFiles(const SceneDescription& scene, const RenderOptions& options) {
    std::vector<std::filesystem::path> written;
    if (options.rendersImages()) written = scene.output.files;
    for (const std::filesystem::path& file : {options.stats, options.writeScene})
        if (!isStdout(file)) written.push_back(file);
    refuseOverwriting(written, filesRead(options.sceneInput(), scene));
}

/// Those of a scene file are known to be right.
ExrLayers layersOf(const SceneDescription& scene) {
    return inPlace("--layers", [&] { return layersFromNames(scene.output.layers); });
}

/// Where the name that a message of ColorConfig begins with was given: "scene.toml:9:8: ".
std::string placeOfDisplayError(const SceneDescription& scene, std::string_view message) {
    for (const std::string key : {"display", "view", "look"}) {
        const std::string place = findPlace(scene.places, "output." + key);
        if (message.starts_with(key + " '") && !place.empty()) return place + ": ";
    }
    return "";
}

Outputs prepareOutputs(const SceneDescription& scene, const RenderOptions& options) {
    const auto check = [&](const std::string& place, const std::filesystem::path& file) {
        if (file.empty() || isStdout(file)) return;
        checkNoPattern(file, place);
        prepareFolder(file, options.mkdir, place);
        inPlace(place, [&] { checkWritable(file); });
    };
    check("--stats", options.stats);
    check("--write-scene", options.writeScene);
    ColorConfig colour =
        inPlace(findPlace(scene.places, "ocio"), [&] { return ColorConfig(scene.ocio); });
    OutputSettings settings{.colour = std::move(colour)};
    if (options.rendersImages()) settings.files = scene.output.files;
    refuseOverwriting(settings.files, settings.colour.files());
    for (std::size_t i = 0; i < settings.files.size(); ++i) {
        const std::string place = findPlace(scene.places, fmt::format("output.files[{}]", i));
        inPlace(place, [&] { imageFormat(settings.files[i]); });
        check(place, settings.files[i]);
    }
    settings.half = scene.output.half;
    settings.layers = layersOf(scene);
    settings.display = {scene.output.display, scene.output.view, scene.output.look,
                        scene.output.exposure};
    settings.withAlpha = environmentIsHidden(scene);
    settings.glows = anythingGlows(scene);
    try {
        return Outputs(std::move(settings));
    } catch (const Error& e) {
        throw Error(e.kind(), placeOfDisplayError(scene, e.what()) + e.what());
    }
}

/// Throws where the image's sums cannot be held, or not written in the end: `writing` are the bytes
/// of a pixel that encoding takes.
void checkMemory(const RenderSettings& settings, const SceneDescription& scene, double writing,
                 double possible) {
    const auto crop = settings.crop.value_or(Film::Window{0, 0, settings.width, settings.height});
    const double kept = double(sizeof(Film::Pixel)) +
                        (scene.surfaces.empty() ? 0 : double(sizeof(Film::SurfacePixel))) +
                        (settings.featureLayers ? double(sizeof(Film::FeaturePixel)) : 0) +
                        (environmentIsHidden(scene) ? 0 : double(sizeof(Film::ForegroundPixel))) +
                        (settings.adaptive ? 5 * double(sizeof(double)) : 0);
    const double needed = double(crop.width()) * crop.height() * (kept + writing);
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

/// The same with what is left once the scene stands.
void checkMemoryLeft(const RenderSettings& settings, const SceneDescription& scene,
                     const Outputs& outputs) {
    // Stacks and buffers of the threads, and what libraries take to write.
    constexpr double ofThread = 16 << 20, ofAll = 64 << 20;
    const int threads = settings.threads > 0
                            ? settings.threads
                            : static_cast<int>(std::thread::hardware_concurrency());
    const double left = static_cast<double>(memoryLeft()) - ofThread * threads - ofAll;
    checkMemory(settings, scene, outputs.bytesPerPixel(), std::max(left, 0.0));
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
    constexpr double encoded = 32;  // of a pixel in an image file with all layers, about
    checkMemory(settings, scene, encoded, static_cast<double>(memoryLimit()));
    return settings;
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    if (isStdout(file))
        printData(text);
    else
        writeWholeFile(file, text);
}

void warnUnlessEmpty(const std::string& text) {
    if (!text.empty()) spdlog::warn("{}", text);
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
    const Needs needs = findNeeds(scene);
    spdlog::info("the scene {}", usedOf(needs));
    if (const std::string unused = unusedOf(needs); !unused.empty())
        spdlog::debug("the scene {}", unused);
    Progress progress(style);
    progress.start(settings);
    RenderResult result = render(scene, settings, [&](const RenderProgress& now) {
        progress.update(now);
        return !interrupted();
    });
    progress.finish(result);
    spdlog::info("{} in {}: {}, {}", stopReasonName(result.reason), formatDuration(result.seconds),
                 samplesText(result, settings), noiseOf(result));
    if (const std::uint64_t count = result.counters.clamped)
        spdlog::info("{} of {} paths were clamped to a radiance of {:g}", count,
                     result.counters.paths, settings.approximations.clamp);
    if (const std::uint64_t count = result.film.nonFiniteCount())
        spdlog::warn("{} samples were not finite and are left out", count);
    const std::uint64_t missing = result.film.pixelsWithoutSamples();
    if (missing > 0 && result.film.mostSamples() > 0)
        spdlog::warn("{} of {} pixels have no sample yet; they are black, with alpha 0{}", missing,
                     std::int64_t{result.film.crop().width()} * result.film.crop().height(),
                     result.reason == StopReason::TimeLimit
                         ? ": one sample of each takes longer than twice the time limit"
                         : "");
    return result;
}

void run(const RenderOptions& options, const std::string& commandLine) {
    const ProgressStyle style = options.reports.start();
    options.check();

    SceneDescription description = describeScene(options);
    catchInterrupts();  // not while a scene that comes through a pipe is waited for
    const std::vector<std::filesystem::path>& files = description.output.files;
    if (files.empty() && options.rendersImages())
        throw usageError("there is no output; name a file with -o, such as -o smoke.exr");
    if (options.rendersImages()) options.checkFor(files);
    checkFiles(description, options);
    RenderSettings settings = renderSettings(description, options);
    const Outputs outputs = prepareOutputs(description, options);
    if (!outputs.note().empty()) spdlog::warn("{}", outputs.note());

    const auto loadStart = std::chrono::steady_clock::now();
    const Openings open = openingsOf(description);
    LoadedScene loaded = loadAndComplete(description);
    checkFiles(description, options);  // with what --set says of lights that were chosen
    if (!options.writeScene.empty()) {
        writeTextFile(options.writeScene,
                      writeScene(description, options.writeScene.parent_path()));
        if (!isStdout(options.writeScene))
            spdlog::info("wrote {}: {}", options.writeScene.string(),
                         describeChoices(open, description));
    }
    if (!options.rendersImages()) return;
    if (options.choosesQuality()) {
        const SceneDescription before = description;
        if (!chooseQuality(description, options, commandLine)) endWith(exitInterrupted);
        if (!haveSameFields(before, description)) loaded = loadScene(description);
        settings = renderSettings(description, options);
    }
    PictureWarnings warnings(description, loaded);
    std::vector<std::string> notes;
    const Scene scene = buildScene(description, std::move(loaded), &notes);
    for (const std::string& note : notes) spdlog::info("{}", note);
    const std::chrono::duration<double> loading = std::chrono::steady_clock::now() - loadStart;
    endIfInterrupted();
    for (const std::string& warning : precisionWarnings(scene)) spdlog::warn("{}", warning);
    warnUnlessEmpty(warnings.ofCamera(scene));

    checkMemoryLeft(settings, description, outputs);
    const RenderResult result = renderWithProgress(scene, settings, style);
    const std::string digest = sceneDigest(description);
    if (result.film.mostSamples() > 0) {
        const std::string note =
            outputs.write(result.film, {settings.firstSample, result.endSample, settings.seed,
                                        result.seconds, digest, commandLine, settings.adaptive});
        for (const std::filesystem::path& file : files) spdlog::info("wrote {}", file.string());
        if (!note.empty()) spdlog::info("{}", note);
        warnUnlessEmpty(warnings.ofPicture(scene, result));
    } else if (result.reason != StopReason::TimeLimit) {
        spdlog::warn("interrupted before anything was rendered: nothing is written");
    }
    const std::string stats =
        statsText(result, settings, digest, loading.count(),
                  result.film.mostSamples() > 0 ? files : std::vector<std::filesystem::path>());
    if (!options.stats.empty()) writeTextFile(options.stats, stats);
    if (options.reports.json) writeTextFile("-", stats);
    if (result.reason == StopReason::Interrupted) endWith(exitInterrupted);
    if (result.film.mostSamples() == 0)
        throw failure(
            "nothing was rendered within twice the time limit of {}: nothing is written. Paths may "
            "be without end: look for media of albedo 1 that fill all space, or give max_bounces "
            "or max_scatterings",
            formatDuration(settings.timeLimit));
}

CLI::App& addTo(CLI::App& app, const std::string& commandLine) {
    CLI::App& command = *app.add_subcommand("render", "Render a scene or a volume to images");
    const auto options = std::make_shared<RenderOptions>();
    options->addTo(command);
    command.callback([options, commandLine] { run(*options, commandLine); });
    return command;
}

}  // namespace

extern const Command renderCommand{&addTo};

}  // namespace woodcock::tool
