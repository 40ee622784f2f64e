// SPDX-License-Identifier: Apache-2.0
#include "tools/render/prepare.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "tools/common/frames.h"
#include "tools/common/output_folders.h"
#include "tools/common/scene_input.h"
#include "tools/render/checkpoint.h"
#include "tools/render/frame_reader.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/denoise/denoiser.h"
#include "woodcock/image/image_format.h"
#include "woodcock/render/tile_order.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/denoising.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/mattes.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

std::string placeOfDenoise(const scene::RenderDescription& render) {
    return "render." + scene::keyName(render, render.denoise);
}

}  // namespace

scene::SceneDescription describeScene(const RenderOptions& options, std::optional<int> frame) {
    SceneInput input = options.sceneInput();
    if (frame) input.files.front() = inFrame(input.files.front(), *frame);
    scene::SceneDescription scene = parseInput(input);
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
    if (options.denoise) {
        render.denoise = *options.denoise ? scene::Denoise::Always : scene::Denoise::Never;
        scene.places[placeOfDenoise(render)] = "--denoise";
    }

    scene::OutputDescription& output = scene.output;
    if (!options.outputs.empty()) {
        output.files = options.outputs;
        std::erase_if(scene.places,
                      [](const auto& place) { return place.first.starts_with("output.files"); });
    }
    if (!options.layers.empty()) output.layers = options.layers;
    if (!options.mattes.empty()) output.mattes = options.mattes;
    const auto replaceFile = [&](std::filesystem::path& file, const std::filesystem::path& option,
                                 const char* name) {
        if (option.empty()) return;
        file = option;
        scene.places["output." + scene::keyName(output, file)] = name;
    };
    replaceFile(output.mattesFile, options.mattesFile, "--mattes-file");
    replaceFile(output.deep, options.deep, "--deep");
    output.deepError = options.deepError.value_or(output.deepError);
    output.half |= options.half;
    output.multipart |= options.multipart;
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

void checkFiles(const scene::SceneDescription& scene, const RenderOptions& options) {
    std::vector<std::filesystem::path> written;
    if (options.rendersImages()) written = imagesOf(scene.output);
    for (const std::filesystem::path& file : {options.stats, options.writeScene})
        if (!isStdout(file)) written.push_back(file);
    if (options.keepsCheckpoint()) written.push_back(checkpointFile(scene.output));
    refuseOverwriting(written, filesRead(options.sceneInput(), scene));
}

namespace {

/// Those of a scene file are known to be right.
image::LayerList layersOf(const scene::SceneDescription& scene) {
    return scene::inPlace("--layers", [&] { return scene::outputLayers(scene); });
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

void prepareCheckpoint(const scene::OutputDescription& output, const RenderOptions& options) {
    const std::string option = options.resume ? "--resume" : "--checkpoint";
    const std::filesystem::path file = checkpointFile(output);
    if (file.empty())
        throw usageError("{} needs an output that is a file: the checkpoint lies beside it",
                         option);
    prepareFolder(file, options.mkdir, option);
    scene::inPlace(option, [&] { checkWritable(file); });
}

}  // namespace

std::vector<image::MatteLayer> mattesOf(const scene::SceneDescription& scene,
                                        std::vector<std::string>* notes) {
    return scene::matteLayers(scene, scene.output.mattes, notes);
}

namespace {

/// Prepares a file for layers: an EXR of its own.
void prepareLayerFile(const scene::SceneDescription& scene, const std::filesystem::path& file,
                      bool mkdir) {
    if (file.empty()) return;
    const std::string place = placeOfLayerFile(scene, file);
    scene::inPlace(place, [&] {
        if (image::imageFormat(file) != image::ImageFormat::Exr)
            throw usageError("'{}' has to be an EXR file (.exr)", file.string());
    });
    prepareOutput(file, mkdir, place);
}

}  // namespace

std::string placeOfLayerFile(const scene::SceneDescription& scene,
                             const std::filesystem::path& file) {
    return scene::findPlace(scene.places, "output." + scene::keyName(scene.output, file));
}

image::Outputs prepareOutputs(const scene::SceneDescription& scene, const RenderOptions& options) {
    if (options.frames.empty() || !namesFrame(options.stats.string()))
        prepareOutput(options.stats, options.mkdir, "--stats");
    prepareOutput(options.writeScene, options.mkdir, "--write-scene");
    if (options.keepsCheckpoint()) prepareCheckpoint(scene.output, options);
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
    if (options.rendersImages()) {
        prepareLayerFile(scene, scene.output.mattesFile, options.mkdir);
        prepareLayerFile(scene, scene.output.deep, options.mkdir);
        settings.matteFile = scene.output.mattesFile;
        settings.deepFile = scene.output.deep;
        settings.matteLayers = scene.output.mattes.size();
        refuseOverwriting(imagesOf(scene.output), settings.colour.files());
    }
    settings.half = scene.output.half;
    settings.layers = layersOf(scene);
    settings.multipart = scene.output.multipart;
    settings.denoised = scene.render.denoise == scene::Denoise::Always;
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

double filmBytesPerPixel(const render::RenderSettings& settings,
                         const scene::SceneDescription& scene) {
    return double(image::Film::bytesPerPixel({.surfaces = !scene.surfaces.empty(),
                                              .features = settings.layers.features,
                                              .background = !scene::environmentIsHidden(scene),
                                              .places = settings.layers.places,
                                              .stops = settings.layers.stops,
                                              .parts = settings.layers.parts})) +
           image::MatteFilm::bytesPerPixel(settings.mattes) + double(sizeof(std::uint32_t)) +
           (settings.adaptive ? 5 * double(sizeof(double)) : 0);
}

namespace {

image::Film::Window cropOf(const render::RenderSettings& settings) {
    return settings.crop.value_or(image::Film::Window{0, 0, settings.width, settings.height});
}

/// Throws where the image's sums cannot be held, or not written in the end: `writing` are the bytes
/// of a pixel that encoding takes; `copies`: checkpoints are written of copies.
void checkMemory(const render::RenderSettings& settings, const scene::SceneDescription& scene,
                 double writing, double possible, bool copies = false) {
    const image::Film::Window crop = cropOf(settings);
    const double kept = filmBytesPerPixel(settings, scene);
    const double needed =
        double(crop.width()) * crop.height() * ((copies ? 2 : 1) * kept + writing);
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

}  // namespace

double writingBytesPerPixel(const render::RenderSettings& settings,
                            const scene::SceneDescription& scene, const image::Outputs& outputs) {
    if (scene.render.denoise != scene::Denoise::Always) return outputs.bytesPerPixel();
    constexpr double denoised = 3 * sizeof(float);
    const image::Film::Window crop = cropOf(settings);
    const double pixels = double(crop.width()) * crop.height();
    return std::max(denoised + outputs.bytesPerPixel(), denoise::bytesToDenoise(pixels) / pixels);
}

void checkMemoryLeft(const render::RenderSettings& settings, const scene::SceneDescription& scene,
                     const image::Outputs& outputs, bool copies, double beside) {
    // Stacks and buffers of the threads, and what libraries take to write.
    constexpr double ofThread = 16 << 20, ofAll = 64 << 20;
    const int threads = settings.threads > 0
                            ? settings.threads
                            : static_cast<int>(std::thread::hardware_concurrency());
    const double left = static_cast<double>(memoryLeft()) - ofThread * threads - ofAll - beside;
    checkMemory(settings, scene, writingBytesPerPixel(settings, scene, outputs),
                std::max(left, 0.0), copies);
}

image::Film::Window pictureOf(const scene::RenderDescription& render,
                              const RenderOptions& options) {
    if (!options.crop) return {0, 0, render.width, render.height};
    const PixelRectangle& p = *options.crop;
    if (p.x1 > render.width || p.y1 > render.height)
        throw usageError("--crop {},{},{},{} reaches beyond the image of {}x{} pixels", p.x0, p.y0,
                         p.x1, p.y1, render.width, render.height);
    return {p.x0, p.y0, p.x1, p.y1};
}

void checkCompositing(const scene::SceneDescription& scene, const RenderOptions& options) {
    const scene::OutputDescription& output = scene.output;
    if (output.mattes.empty() && !output.mattesFile.empty())
        throw usageError("{} is for mattes, and none are asked for; give --mattes object",
                         output.mattesFile.string());
    if (output.deep.empty() && options.deepError)
        throw usageError("--deep-error is for deep pixels; give --deep FILE.exr, too");
    const bool exr = std::any_of(output.files.begin(), output.files.end(), [](const auto& file) {
        return image::imageFormat(file) == image::ImageFormat::Exr;
    });
    if (!output.mattes.empty() && output.mattesFile.empty() && !exr)
        throw usageError(
            "mattes need an EXR file, and no output is one; give --mattes-file, or -o "
            "of an .exr");
    if (output.mattes.empty() && output.deep.empty()) return;
    if (options.choosesQuality())
        throw usageError(
            "--quality auto may choose what mattes and deep pixels cannot have; give --quality "
            "final");
    const bool deep = !output.deep.empty();
    if (const std::string flaw = render::compositingFlaw(scene.render.approximations, deep);
        !flaw.empty())
        throw usageError("{}", flaw);
}

std::optional<denoise::Denoiser> denoiserOf(scene::SceneDescription& scene,
                                            const RenderOptions& options,
                                            std::vector<std::string>* notes) {
    scene::Denoise& denoise = scene.render.denoise;
    if (options.drawsPart() && denoise == scene::Denoise::Always)
        throw usageError(
            "{}: {} draws a part of a picture, and only a whole picture is denoised. Render the "
            "parts with --no-denoise --layers albedo,normal, and put them together by woodcock "
            "merge --denoise",
            scene::findPlace(scene.places, placeOfDenoise(scene.render)),
            options.tile ? "--tile" : "--samples");
    if (options.drawsPart()) denoise = scene::Denoise::Never;
    return scene::settleDenoising(scene, notes);
}

render::RenderSettings renderSettings(const scene::SceneDescription& scene,
                                      const RenderOptions& options) {
    const scene::RenderDescription& render = scene.render;
    render::RenderSettings settings = woodcock::scene::renderSettings(render);
    const image::Film::Window picture = pictureOf(render, options);
    if (options.crop) settings.crop = picture;
    if (options.tile)
        settings.crop = scene::inPlace("--tile", [&] {
            return render::pictureTile(picture, options.tile->index, options.tile->count);
        });
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
    settings.layers = scene::inPlace("--layers", [&] { return scene::layerNeeds(scene); });
    settings.mattes = mattesOf(scene);
    if (!scene.output.deep.empty()) settings.deepError = scene.output.deepError;
    constexpr double encoded = 32;  // of a pixel in an image file with all layers, about
    checkMemory(settings, scene, encoded, static_cast<double>(memoryLimit()));
    return settings;
}

}  // namespace woodcock::tool
