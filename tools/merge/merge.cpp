// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <climits>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/common/command.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/picture_facts.h"
#include "tools/common/progress.h"
#include "tools/common/report_options.h"
#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/denoise/denoiser.h"
#include "woodcock/image/image_format.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/merge_parts.h"
#include "woodcock/render/saved_state.h"

namespace woodcock::tool {

namespace {

struct MergeOptions {
    std::vector<std::filesystem::path> parts, outputs;
    std::filesystem::path mattesFile, deep;
    std::vector<std::string> layers;
    std::optional<double> exposure;
    bool mkdir = false, partial = false, denoise = false;
    std::optional<int> spp;
    ReportOptions reports;

    std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> all = outputs;
        for (const std::filesystem::path& file : {mattesFile, deep})
            if (!file.empty()) all.push_back(file);
        return all;
    }
};

/// The pictures are those that the first part tells of, where the options say nothing else.
image::Outputs prepareOutputs(const MergeOptions& options, const PictureFacts& facts,
                              const std::vector<std::string>& groups) {
    const scene::OutputDescription& output = facts.output;
    image::OutputSettings settings{.colour = image::ColorConfig(facts.ocio)};
    settings.files = options.outputs;
    settings.matteFile = options.mattesFile;
    settings.deepFile = options.deep;
    for (const std::filesystem::path& file : options.files()) {
        image::imageFormat(file);
        prepareOutput(file, options.mkdir, "");
    }
    refuseOverwriting(options.files(), settings.colour.files());
    settings.half = output.half;
    settings.multipart = output.multipart;
    settings.layers = image::layersFromNames(
        options.layers.empty() ? output.layers : options.layers, groups, output.half);
    settings.denoised = options.denoise;
    if (options.denoise) image::dropLayersOfNoise(settings.layers);
    settings.display = {output.display, output.view, output.look,
                        options.exposure.value_or(output.exposure)};
    settings.withAlpha = facts.withAlpha;
    settings.glows = facts.glows;
    return image::Outputs(std::move(settings));
}

/// Throws where there is no denoiser, or the parts do not hold what it needs.
std::optional<denoise::Denoiser> denoiserOf(const MergeOptions& options,
                                            const image::StateFile& first) {
    if (!options.denoise) return {};
    if (!image::Film::keptIn(first.planes()).features)
        throw usageError(
            "--denoise needs the layers albedo and normal, and the parts were rendered without "
            "them; render them with --layers albedo,normal");
    return scene::inPlace("--denoise", [] { return denoise::Denoiser::load(); });
}

/// Throws where the parts hold nothing of a layer.
void checkLayers(const MergeOptions& options, const image::StateFile& first) {
    const image::Film::Kept kept = image::Film::keptIn(first.planes());
    const bool depth = first.fact("sampled").starts_with("depth");
    for (const image::ChosenLayer& chosen :
         image::layersFromNames(options.layers, kept.parts.groups)) {
        const image::LayerNeeds needs = image::needsOf({chosen});
        const bool there = (depth || !needs.depthSamples()) && (kept.features || !needs.features) &&
                           (kept.places || !needs.places) && (kept.stops || !needs.stops) &&
                           (kept.parts.kinds || !needs.parts.kinds);
        if (!there)
            throw usageError(
                "the parts hold nothing of the layer '{}': they were rendered without it",
                chosen.layer.name);
    }
}

/// Throws where files are asked for of which the parts hold nothing.
void checkCompositing(const MergeOptions& options, const image::StateFile& first) {
    const auto demand = [](const std::filesystem::path& file, const char* option, bool there,
                           const char* what, const char* made) {
        if (!file.empty() && !there)
            throw usageError("{}: the parts hold no {}: they were rendered without {}", option,
                             what, made);
    };
    demand(options.mattesFile, "--mattes-file", !render::matteLayersIn(first).empty(), "mattes",
           "--mattes");
    demand(options.deep, "--deep", image::DeepState::isIn(first), "deep pixels", "--deep");
}

void checkSameLayers(const MergeOptions& options) {
    if (!options.layers.empty()) return;
    const image::StateFile first(options.parts.front(), "part");
    for (const std::filesystem::path& path : options.parts) {
        const image::StateFile part(path, "part");
        if (part.fact("layers") != first.fact("layers"))
            throw inputError(
                "'{}' and '{}' have different layers ('{}' and '{}'); name those to write with "
                "--layers",
                first.file().string(), path.string(), first.fact("layers"), part.fact("layers"));
    }
}

void report(const MergeOptions& options, const render::MergedParts& merged) {
    const image::Film& film = merged.film;
    const double noise = film.noise();
    spdlog::info("{} parts, {} to {} samples per pixel, {}", options.parts.size(),
                 film.fewestSamples(), film.mostSamples(), noiseText(noise));
    if (merged.deep && options.deep.empty())
        spdlog::info("the parts hold deep pixels, too; --deep FILE.exr writes them");
    for (const std::string& what : merged.missing) spdlog::warn("{}", what);
    if (!options.reports.json) return;
    std::vector<std::string> files;
    for (const std::filesystem::path& file : options.files()) files.push_back(file.string());
    printJson(nlohmann::ordered_json{{"files", files},
                                     {"parts", options.parts.size()},
                                     {"seeds", merged.seeds},
                                     {"first_sample", merged.firstSample},
                                     {"end_sample", merged.endSample},
                                     {"adaptive", merged.adaptive},
                                     {"samples_mean", film.meanSamples()},
                                     {"samples_fewest", film.fewestSamples()},
                                     {"samples_most", film.mostSamples()},
                                     {"render_seconds", merged.seconds},
                                     {"noise", noise},
                                     {"non_finite", film.nonFiniteCount()},
                                     {"missing", merged.missing}},
              4);
}

void runMerge(const MergeOptions& options, const std::string& commandLine) {
    options.reports.start();
    refuseOverwriting(options.files(), options.parts);
    const image::StateFile first(options.parts.front(), "part");
    checkLayers(options, first);
    checkCompositing(options, first);
    checkSameLayers(options);
    const std::optional<denoise::Denoiser> denoiser = denoiserOf(options, first);
    const PictureFacts facts = pictureFactsOf(first);
    const image::Outputs outputs =
        prepareOutputs(options, facts, image::Film::keptIn(first.planes()).parts.groups);
    const render::MergedParts merged =
        render::mergeParts(options.parts, {options.partial, options.spp});
    image::RenderMetadata metadata = facts.shot;
    metadata.firstSample = merged.firstSample, metadata.endSample = merged.endSample;
    metadata.seed = merged.seeds.front();
    metadata.renderSeconds = merged.seconds;
    metadata.sceneDigest = first.fact("scene");
    metadata.commandLine = commandLine;
    metadata.adaptive = merged.adaptive;
    std::optional<image::DenoisedPicture> denoised;
    if (denoiser) denoised = denoiser->denoise(merged.film);
    const std::string note =
        outputs.write(merged.film, metadata,
                      {merged.mattes ? &*merged.mattes : nullptr,
                       merged.deep ? &*merged.deep : nullptr, denoised ? &*denoised : nullptr});
    for (const std::filesystem::path& file : options.files())
        spdlog::info("wrote {}", file.string());
    if (!note.empty()) spdlog::info("{}", note);
    report(options, merged);
}

CLI::App& addTo(CLI::App& app, const std::string& commandLine) {
    const auto options = std::make_shared<MergeOptions>();
    MergeOptions& o = *options;
    CLI::App& command = *app.add_subcommand(
        "merge", "Put parts of a picture together: ranges of samples, tiles, other seeds");
    command
        .add_option("PART", o.parts,
                    "EXR files of woodcock render with --samples, --tile or --mergeable, or its "
                    "checkpoints")
        ->required()
        ->type_name("FILE");
    addList(command, "-o,--output", o.outputs,
            "Image to write: .exr, or a picture such as .png. Pictures look as those of the parts "
            "would")
        ->required()
        ->type_name("FILE");
    addList(command, "--layers", o.layers,
            "More layers for EXR files, in place of those that the parts have")
        ->delimiter(',')
        ->type_name("LAYER,...");
    command
        .add_option("--mattes-file", o.mattesFile,
                    "Write the parts' mattes into an EXR file of their own. Without it, they are "
                    "in the EXR files of -o")
        ->type_name("FILE");
    command
        .add_option("--deep", o.deep,
                    "Write the parts' deep pixels into this EXR file. They were rendered with "
                    "--deep, too")
        ->type_name("FILE");
    addParsed(
        command, "--exposure", o.exposure,
        [](const std::string& text) { return parseNumber(text, -100, 100); },
        "Make pictures brighter by this many stops, in place of the parts' exposure")
        ->type_name("NUMBER");
    command.add_flag("--denoise", o.denoise,
                     "Denoise the picture by Open Image Denoise. The parts must have the layers "
                     "albedo and normal; see woodcock render --help");
    addMkdir(command, o.mkdir);
    addCount(command, "--spp", o.spp, 1, INT_MAX,
             "Refuse parts that do not reach so many samples in every pixel. Without it, nothing "
             "tells that the last range is missing");
    command.add_flag("--partial", o.partial,
                     "Merge what is there where parts are missing, instead of stopping");
    o.reports.addTo(command, "Print counts and what is missing as a JSON object on stdout");
    command.footer(examplesText({"woodcock merge part0.exr part1.exr -o smoke.exr -o smoke.png",
                                 "woodcock merge tile.exr -o smoke.exr --partial"}));
    command.callback([options, commandLine] { runMerge(*options, commandLine); });
    return command;
}

}  // namespace

extern const Command mergeCommand{&addTo};

}  // namespace woodcock::tool
