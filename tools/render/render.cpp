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
#include "tools/render/choose_exposure.h"
#include "tools/render/choose_samples.h"
#include "tools/render/options.h"
#include "tools/render/picture_warnings.h"
#include "tools/render/quality_auto.h"
#include "tools/render/trial.h"
#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/image_format.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/needs.h"
#include "woodcock/render/precision.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

scene::SceneDescription describeScene(const RenderOptions& options) {
    scene::SceneDescription scene = parseInput(options.sceneInput());
    for (scene::VolumeDescription& volume : scene.volumes) {
        if (options.storage) volume.storage = *options.storage;
        volume.repair |= options.repair;
    }
    scene::RenderDescription& render = scene.render;
    render.spp = options.spp.value_or(render.spp);
    render.seed = options.seed.value_or(render.seed);
    render.timeLimit = options.timeLimit.value_or(render.timeLimit);
    render.noise = options.noise.value_or(render.noise);
    if (options.adaptive) render.adaptive = options.adaptive;

    scene::OutputDescription& output = scene.output;
    if (!options.outputs.empty()) {
        output.files = options.outputs;
        std::erase_if(scene.places,
                      [](const auto& place) { return place.first.starts_with("output.files"); });
    }
    if (!options.layers.empty()) output.layers = options.layers;
    output.half |= options.half;
    const auto replaceName = [&](std::string& name, const auto& option) {
        if (!option) return;
        name = *option;
        const std::string& key = scene::keyName(output, name);
        scene.places[fmt::format("output.{}", key)] = fmt::format("--{}", key);
    };
    replaceName(output.display, options.display);
    replaceName(output.view, options.view);
    replaceName(output.look, options.look);
    if (options.exposure) {
        output.exposure = *options.exposure;
        scene.places["output.exposure"] = "--exposure";
    }
    if (!options.ocio.empty()) {
        scene.ocio = options.ocio;
        scene.places[scene::keyName(scene, scene.ocio)] = "--ocio";
    }
    return scene;
}

bool isStdout(const std::filesystem::path& file) { return file == "-"; }

/// Nothing that is read may be written over, and nothing that is written may be written twice.
void checkFiles(const scene::SceneDescription& scene, const RenderOptions& options) {
    std::vector<std::filesystem::path> written;
    if (options.rendersImages()) written = scene.output.files;
    for (const std::filesystem::path& file : {options.stats, options.writeScene})
        if (!isStdout(file)) written.push_back(file);
    refuseOverwriting(written, filesRead(options.sceneInput(), scene));
}

/// Those of a scene file are known to be right.
image::ExrLayers layersOf(const scene::SceneDescription& scene) {
    return scene::inPlace("--layers", [&] { return image::layersFromNames(scene.output.layers); });
}

/// Where the name that a message of ColorConfig begins with was given: "scene.toml:9:8: ".
std::string placeOfDisplayError(const scene::SceneDescription& scene, std::string_view message) {
    const scene::OutputDescription& output = scene.output;
    for (const std::string* name : {&output.display, &output.view, &output.look}) {
        const std::string& key = scene::keyName(output, *name);
        const std::string place = scene::findPlace(scene.places, "output." + key);
        if (message.starts_with(key + " '") && !place.empty()) return place + ": ";
    }
    return "";
}

image::Outputs prepareOutputs(const scene::SceneDescription& scene, const RenderOptions& options) {
    prepareOutput(options.stats, options.mkdir, "--stats");
    prepareOutput(options.writeScene, options.mkdir, "--write-scene");
    image::ColorConfig colour =
        scene::inPlace(scene::findPlace(scene.places, scene::keyName(scene, scene.ocio)),
                       [&] { return image::ColorConfig(scene.ocio); });
    image::OutputSettings settings{.colour = std::move(colour)};
    if (options.rendersImages()) settings.files = scene.output.files;
    refuseOverwriting(settings.files, settings.colour.files());
    for (std::size_t i = 0; i < settings.files.size(); ++i) {
        const std::string place =
            scene::findPlace(scene.places, fmt::format("output.files[{}]", i));
        scene::inPlace(place, [&] { image::imageFormat(settings.files[i]); });
        prepareOutput(settings.files[i], options.mkdir, place);
    }
    settings.half = scene.output.half;
    settings.layers = layersOf(scene);
    settings.display = {scene.output.display, scene.output.view, scene.output.look,
                        scene.output.exposure};
    settings.withAlpha = scene::environmentIsHidden(scene);
    settings.glows = scene::anythingGlows(scene);
    try {
        return image::Outputs(std::move(settings));
    } catch (const Error& e) {
        throw Error(e.kind(), placeOfDisplayError(scene, e.what()) + e.what());
    }
}

/// Throws where the image's sums cannot be held, or not written in the end: `writing` are the bytes
/// of a pixel that encoding takes.
void checkMemory(const render::RenderSettings& settings, const scene::SceneDescription& scene,
                 double writing, double possible) {
    const auto crop =
        settings.crop.value_or(image::Film::Window{0, 0, settings.width, settings.height});
    const double kept =
        double(sizeof(image::Film::Pixel)) +
        (scene.surfaces.empty() ? 0 : double(sizeof(image::Film::SurfacePixel))) +
        (settings.featureLayers ? double(sizeof(image::Film::FeaturePixel)) : 0) +
        (scene::environmentIsHidden(scene) ? 0 : double(sizeof(image::Film::ForegroundPixel))) +
        (settings.adaptive ? 5 * double(sizeof(double)) : 0);
    const double needed = double(crop.width()) * crop.height() * (kept + writing);
    if (needed <= possible) return;
    const double share = std::sqrt(possible / needed);
    const std::string place = scene::findPlace(scene.places, "render.resolution");
    throw Error(
        place == "--res" ? ErrorKind::Usage : ErrorKind::Input,
        fmt::format("{}{}{} x {} pixels need {} of memory, and there are {}; {:.0f} x {:.0f} "
                    "is possible, or parts of the image by --crop",
                    place, place.empty() ? "" : ": ", crop.width(), crop.height(),
                    formatGiB(needed), formatGiB(possible), std::floor(crop.width() * share),
                    std::floor(crop.height() * share)));
}

/// The same with what is left once the scene stands.
void checkMemoryLeft(const render::RenderSettings& settings, const scene::SceneDescription& scene,
                     const image::Outputs& outputs) {
    // Stacks and buffers of the threads, and what libraries take to write.
    constexpr double ofThread = 16 << 20, ofAll = 64 << 20;
    const int threads = settings.threads > 0
                            ? settings.threads
                            : static_cast<int>(std::thread::hardware_concurrency());
    const double left = static_cast<double>(memoryLeft()) - ofThread * threads - ofAll;
    checkMemory(settings, scene, outputs.bytesPerPixel(), std::max(left, 0.0));
}

render::RenderSettings renderSettings(const scene::SceneDescription& scene,
                                      const RenderOptions& options) {
    const scene::RenderDescription& render = scene.render;
    render::RenderSettings settings = woodcock::scene::renderSettings(render);
    if (options.crop) {
        const PixelRectangle& p = *options.crop;
        if (p.x1 > render.width || p.y1 > render.height)
            throw usageError("--crop {},{},{},{} reaches beyond the image of {}x{} pixels", p.x0,
                             p.y0, p.x1, p.y1, render.width, render.height);
        settings.crop = image::Film::Window{p.x0, p.y0, p.x1, p.y1};
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
    const image::ExrLayers layers = layersOf(scene);
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

bool haveSameFields(const scene::SceneDescription& a, const scene::SceneDescription& b) {
    const scene::RenderDescription &ra = a.render, &rb = b.render;
    return a.volumes == b.volumes && ra.storage == rb.storage && ra.lookup == rb.lookup &&
           ra.levelOfDetail == rb.levelOfDetail;
}

std::string samplesText(const render::RenderResult& result,
                        const render::RenderSettings& settings) {
    if (!settings.adaptive)
        return fmt::format("samples {}:{} of each pixel", settings.firstSample, result.endSample);
    const image::Film& film = result.film;
    return fmt::format("the work of {} samples per pixel, {} to {} of them, {:.3g} in the mean",
                       result.endSample, film.fewestSamples(), film.mostSamples(),
                       film.meanSamples());
}

/// Numbers that say how well the render went.
void reportResult(const render::RenderResult& result, const render::RenderSettings& settings) {
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
                     result.reason == render::StopReason::TimeLimit
                         ? ": one sample of each takes longer than twice the time limit"
                         : "");
}

void reportNeeds(const render::Scene& scene) {
    const render::Needs needs = render::findNeeds(scene);
    spdlog::info("the scene {}", render::usedOf(needs));
    if (const std::string unused = render::unusedOf(needs); !unused.empty())
        spdlog::debug("the scene {}", unused);
}

/// One call of the command, in its phases: check, load, build, render, write.
class RenderJob {
public:
    RenderJob(const RenderOptions& options, const std::string& commandLine)
        : options_(options), commandLine_(commandLine), style_(options.reports.start()) {}

    void run() {
        options_.check();
        description_ = describeScene(options_);
        catchInterrupts();  // not while a scene that comes through a pipe is waited for
        checkWhatIsAsked();
        settings_ = renderSettings(description_, options_);
        image::Outputs outputs = prepareOutputs(description_, options_);
        if (!outputs.note().empty()) spdlog::warn("{}", outputs.note());

        loadStart_ = std::chrono::steady_clock::now();
        if (load()) outputs = prepareOutputs(description_, options_);
        if (options_.rendersImages()) render(outputs);
    }

private:
    const std::vector<std::filesystem::path>& files() const { return description_.output.files; }

    void checkWhatIsAsked() const {
        if (files().empty() && options_.rendersImages())
            throw usageError("there is no output; name a file with -o, such as -o smoke.exr");
        if (options_.rendersImages()) options_.checkFor(files());
        checkFiles(description_, options_);
    }

    /// Returns whether an exposure was chosen.
    bool load() {
        const Openings open = openingsOf(description_);
        const std::filesystem::path frame =
            options_.plain ? std::filesystem::path() : frameToChooseFrom(description_);
        loaded_ = loadAndComplete(description_, options_.choicesLook());
        checkFiles(description_, options_);  // with what --set says of lights that were chosen
        const bool exposes = open.exposure && open.lights && !description_.lights.empty() &&
                             !options_.plain && writesPictureOrScene();
        const bool counts = options_.leavesSamplesOpen(description_);
        if (exposes || counts) {
            const render::RenderResult trial = renderTrial(frame);
            if (exposes) {
                description_.output.exposure = chooseExposure(trial.film, displayTransform());
                spdlog::info(
                    "chosen, so that its bright parts are near white:\n[output]\nexposure = {}",
                    tomlNumber(description_.output.exposure));
            }
            if (counts) countSamples(trial);
        }
        saveScene(open);
        return exposes;
    }

    bool writesPictureOrScene() const {
        return !options_.writeScene.empty() ||
               std::any_of(files().begin(), files().end(), [](const auto& file) {
                   return image::imageFormat(file) != image::ImageFormat::Exr;
               });
    }

    /// Of the frame from which all is chosen.
    render::RenderResult renderTrial(const std::filesystem::path& frame) const {
        const bool other = !frame.empty() && frame != description_.volumes[0].file;
        scene::SceneDescription scene = description_;
        if (other) scene.volumes[0].file = frame;
        return tool::renderTrial(
            scene::buildScene(scene, other ? scene::loadScene(scene) : loaded_), settings_);
    }

    image::DisplayTransform displayTransform() const {
        const scene::OutputDescription& output = description_.output;
        return image::ColorConfig(description_.ocio)
            .displayTransform({output.display, output.view, output.look, 0});
    }

    void countSamples(const render::RenderResult& trial) {
        const ChosenSamples chosen = chooseSamples(trial);
        description_.render.spp = settings_.endSample = chosen.perPixel;
        spdlog::info("{}:\n[render]\nspp = {}", describe(chosen), chosen.perPixel);
    }

    void saveScene(const Openings& open) const {
        const std::filesystem::path& file = options_.writeScene;
        if (file.empty()) return;
        writeTextFile(file, scene::writeScene(description_, file.parent_path()));
        if (!isStdout(file))
            spdlog::info("wrote {}: {}", file.string(), describeChoices(open, description_));
    }

    /// For --quality auto.
    void chooseSettings() {
        const scene::SceneDescription before = description_;
        if (!chooseQuality(description_, options_, commandLine_)) endWith(exitInterrupted);
        if (!haveSameFields(before, description_)) loaded_ = scene::loadScene(description_);
        settings_ = renderSettings(description_, options_);
    }

    void render(const image::Outputs& outputs) {
        if (options_.choosesQuality()) chooseSettings();
        PictureWarnings warnings(description_, loaded_);
        std::vector<std::string> notes;
        const render::Scene scene = scene::buildScene(description_, std::move(loaded_), &notes);
        for (const std::string& note : notes) spdlog::info("{}", note);
        const std::chrono::duration<double> loading = std::chrono::steady_clock::now() - loadStart_;
        endIfInterrupted();
        for (const std::string& warning : render::precisionWarnings(scene))
            spdlog::warn("{}", warning);
        warnUnlessEmpty(warnings.ofCamera(scene));

        checkMemoryLeft(settings_, description_, outputs);
        reportNeeds(scene);
        const render::RenderResult result = renderWithProgress(scene, settings_, style_);
        reportResult(result, settings_);
        const std::string digest = scene::sceneDigest(description_);
        write(result, outputs, digest);
        if (result.film.mostSamples() > 0) warnUnlessEmpty(warnings.ofPicture(scene, result));
        writeStats(result, digest, loading.count());
        if (result.reason == render::StopReason::Interrupted) endWith(exitInterrupted);
        if (result.film.mostSamples() == 0)
            throw failure(
                "nothing was rendered within twice the time limit of {}: nothing is written. Paths "
                "may be without end: look for media of albedo 1 that fill all space, or give "
                "max_bounces or max_scatterings",
                formatDuration(settings_.timeLimit));
    }

    void write(const render::RenderResult& result, const image::Outputs& outputs,
               const std::string& digest) const {
        if (result.film.mostSamples() > 0) {
            const std::string note = outputs.write(
                result.film, {settings_.firstSample, result.endSample, settings_.seed,
                              result.seconds, digest, commandLine_, settings_.adaptive});
            for (const std::filesystem::path& file : files())
                spdlog::info("wrote {}", file.string());
            if (!note.empty()) spdlog::info("{}", note);
        } else if (result.reason != render::StopReason::TimeLimit) {
            spdlog::warn("interrupted before anything was rendered: nothing is written");
        }
    }

    void writeStats(const render::RenderResult& result, const std::string& digest,
                    double loadSeconds) const {
        const std::string stats = statsText(
            result, settings_, digest, loadSeconds,
            result.film.mostSamples() > 0 ? files() : std::vector<std::filesystem::path>());
        if (!options_.stats.empty()) writeTextFile(options_.stats, stats);
        if (options_.reports.json) writeTextFile("-", stats);
    }

    const RenderOptions& options_;
    const std::string& commandLine_;
    ProgressStyle style_;
    scene::SceneDescription description_;
    render::RenderSettings settings_;
    scene::LoadedScene loaded_;
    std::chrono::steady_clock::time_point loadStart_;
};

CLI::App& addTo(CLI::App& app, const std::string& commandLine) {
    CLI::App& command = *app.add_subcommand("render", "Render a scene or a volume to images");
    const auto options = std::make_shared<RenderOptions>();
    options->addTo(command);
    command.callback([options, commandLine] { RenderJob(*options, commandLine).run(); });
    return command;
}

}  // namespace

extern const Command renderCommand{&addTo};

}  // namespace woodcock::tool
