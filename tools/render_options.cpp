// SPDX-License-Identifier: Apache-2.0
#include "render_options.h"

#include <algorithm>
#include <climits>

#include "option_kinds.h"
#include "scene_input.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/scene/quality.h"

namespace woodcock::tool {

namespace {

void addOutput(CLI::App& command, RenderOptions& o) {
    std::vector<CLI::Option*> options{
        addList(command, "-o,--output", o.outputs, "Image to write: .exr, .png or .jpg")
            ->type_name("FILE"),
        addList(command, "--layers", o.layers, "Further EXR layers: " + joinNames(layerNames()))
            ->delimiter(',')
            ->type_name("LAYER,..."),
        command.add_flag("--half", o.half, "EXR colour in half precision"),
        command.add_option("--display", o.display, "OpenColorIO display of PNG and JPEG files")
            ->type_name("NAME"),
        command.add_option("--view", o.view, "OpenColorIO view")->type_name("NAME"),
        command.add_option("--look", o.look, "OpenColorIO look, instead of the view's own")
            ->type_name("NAME"),
        addParsed(
            command, "--exposure", o.exposure,
            [](const std::string& text) { return parseNumber(text, -100, 100); },
            "Stops, before the display transform")
            ->type_name("NUMBER"),
        command.add_option("--ocio", o.ocio, "OpenColorIO config, before the scene's and $OCIO")
            ->type_name("FILE")};
    for (CLI::Option* option : options) option->group("Output");
}

void addRendering(CLI::App& command, RenderOptions& o) {
    std::vector<std::string> qualities(qualityNames.begin(), qualityNames.end());
    qualities.push_back("auto");
    std::vector<CLI::Option*> options{
        addChoice(command, "--quality", o.quality, qualities,
                  "Instead of the scene's choices; auto: the best for the --time-limit or --noise, "
                  "measured on the scene:")
            ->type_name("QUALITY"),
        addParsed(command, "--res", o.size, parseImageSize,
                  "Image size; a width alone keeps the scene's shape")
            ->type_name("WIDTHxHEIGHT"),
        addParsed(command, "--crop", o.crop, parsePixelRectangle,
                  "Render only pixels [X0, X1) x [Y0, Y1), y down")
            ->type_name("X0,Y0,X1,Y1"),
        addCount(command, "--spp", o.spp, 1, INT_MAX,
                 "Samples per pixel; adaptive renders do as much work with other numbers"),
        addParsed(command, "--samples", o.samples, parseSampleRange,
                  "Samples FIRST to END - 1 of each pixel, for farms that merge")
            ->type_name("FIRST:END"),
        addCount(command, "--seed", o.seed, 0, INT64_MAX, "Of the random numbers"),
        addParsed(command, "--time-limit", o.timeLimit, parseDuration,
                  "Stop after this long, such as 90s, 5m, 2h")
            ->type_name("TIME"),
        addParsed(command, "--noise", o.noise, parseFraction,
                  "Stop when the noise is below this, such as 1%: the relative standard error of "
                  "what the scene shows; plain background does not count")
            ->type_name("FRACTION"),
        command.add_flag_function(
            "--adaptive,!--no-adaptive", [&o](std::int64_t times) { o.adaptive = times > 0; },
            "More samples where the error is larger, fewer elsewhere, in the same time"),
        addCount(command, "--threads", o.threads, 0, 4096, "0: one for each core")};
    for (CLI::Option* option : options) option->group("Rendering");
}

void addScene(CLI::App& command, RenderOptions& o) {
    std::vector<CLI::Option*> options{
        addList(command, "--set", o.overrides,
                "Set a value of the scene, such as volume[0].scale=2")
            ->type_name("KEY=VALUE"),
        command
            .add_option("--write-scene", o.writeScene,
                        "Save the scene with all that was chosen, and render only where -o is "
                        "given; - is stdout")
            ->type_name("FILE"),
        command.add_flag("--repair", o.repair,
                         "Set NaN, infinite and negative voxels to zero instead of stopping"),
        addEnum(command, "--storage", o.storage, storageNames, "Of voxels in memory:")
            ->type_name("KIND")};
    for (CLI::Option* option : options) option->group("Scene");
}

void addReports(CLI::App& command, RenderOptions& o) {
    const std::vector<std::string> styles{"auto", "bar", "json", "none"};
    const std::vector<std::string> levels{"trace", "debug", "info", "warning", "error", "off"};
    std::vector<CLI::Option*> options{
        addChoice(command, "--progress", o.progress, styles, "How to show it:")->type_name("STYLE"),
        command.add_option("--stats", o.stats, "Write counts and times as JSON; - is stdout")
            ->type_name("FILE"),
        addChoice(command, "--log-level", o.logLevel, levels, "The least to report:")
            ->type_name("LEVEL"),
        command.add_flag("-q,--quiet", o.quiet, "Report warnings and errors only")};
    for (CLI::Option* option : options) option->group("Reports");
}

bool hasExtension(const std::filesystem::path& file, const char* extension) {
    return CLI::detail::to_lower(file.extension().string()) == extension;
}
bool isExrFile(const std::filesystem::path& file) { return hasExtension(file, ".exr"); }

/// An option that would do nothing is a mistake.
void demandFile(bool given, const char* option, const char* kind, bool written) {
    if (given && !written)
        throw usageError("{} is for {} files, and no output is one", option, kind);
}

void exclude(bool first, bool second, const char* names) {
    if (first && second) throw usageError("{} contradict each other; give one of them", names);
}

}  // namespace

void RenderOptions::addTo(CLI::App& command) {
    command.add_option("INPUT", inputs, "A scene (.toml), or one or more volumes (.vdb, .nvdb)")
        ->required()
        ->type_name("FILE");
    addOutput(command, *this);
    addRendering(command, *this);
    addScene(command, *this);
    addReports(command, *this);
}

SceneInput RenderOptions::sceneInput() const {
    SceneInput input{inputs, overrides, size};
    if (quality && !choosesQuality())
        input.overrides.insert(input.overrides.begin(), "render.quality=" + *quality);
    return input;
}

void RenderOptions::check() const {
    checkInput(sceneInput());
    exclude(choosesQuality(), storage.has_value(), "--quality auto and --storage");
    exclude(choosesQuality(), samples.has_value(), "--quality auto and --samples");
    if (choosesQuality() && !timeLimit && !noise)
        throw usageError(
            "--quality auto needs to know what for: give --time-limit, such as 60s, or --noise, "
            "such as 1%");
    exclude(spp.has_value(), samples.has_value(), "--spp and --samples");
    exclude(quiet, logLevel.has_value(), "--quiet and --log-level");
    exclude(quiet, progress == "bar" || progress == "json", "--quiet and --progress");
    for (auto layer = layers.begin(); layer != layers.end(); ++layer)
        if (std::find(layers.begin(), layer, *layer) != layer)
            throw usageError("--layers names '{}' twice", *layer);
    if (!stats.empty() && !rendersImages())
        throw usageError(
            "--stats tells of a render, but --write-scene only saves the scene where no -o names "
            "an "
            "image");
}

void RenderOptions::checkFor(const std::vector<std::filesystem::path>& files) const {
    const bool exr = std::any_of(files.begin(), files.end(), isExrFile);
    const bool picture = !std::all_of(files.begin(), files.end(), isExrFile);
    demandFile(!layers.empty(), "--layers", "EXR", exr);
    demandFile(half, "--half", "EXR", exr);
    demandFile(display.has_value(), "--display", "PNG and JPEG", picture);
    demandFile(view.has_value(), "--view", "PNG and JPEG", picture);
    demandFile(look.has_value(), "--look", "PNG and JPEG", picture);
    demandFile(exposure.has_value(), "--exposure", "PNG and JPEG", picture);
}

}  // namespace woodcock::tool
