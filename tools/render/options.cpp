// SPDX-License-Identifier: Apache-2.0
#include "tools/render/options.h"

#include <algorithm>
#include <climits>

#include "tools/common/frames.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/scene_input.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/denoise/denoiser.h"
#include "woodcock/image/cryptomatte.h"
#include "woodcock/image/layers.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/quality.h"

namespace woodcock::tool {

namespace {

void addOutput(CLI::App& command, RenderOptions& o) {
    std::vector<CLI::Option*> options{
        addList(command, "-o,--output", o.outputs,
                "Image to write: .exr keeps the radiance; .png, .jpg, .tif (16 bits) and .webp are "
                "pictures to look at")
            ->type_name("FILE"),
        addList(command, "--layers", o.layers,
                "Layers of EXR files beside R, G, B and A. all stands for every one, default for "
                "none, lightgroups for all light groups of the scene. :half or :float behind a "
                "name says its precision, as in emission:half: " +
                    joinNames(image::layerNames()))
            ->delimiter(',')
            ->type_name("LAYER,..."),
        addList(command, "--mattes", o.mattes,
                "Cryptomatte in EXR files, by " + joinNames(image::matteKinds()))
            ->delimiter(',')
            ->type_name("KIND,..."),
        command
            .add_option("--mattes-file", o.mattesFile,
                        "Write the mattes into an EXR file of their own")
            ->type_name("FILE"),
        command
            .add_option("--deep", o.deep,
                        "Write deep pixels into this EXR file: the picture by depth, for merging "
                        "with other pictures")
            ->type_name("FILE"),
        addParsed(
            command, "--deep-error", o.deepError,
            [](const std::string& text) { return parseNumber(text, 1e-4, 0.5); },
            "How far the transmittance of deep pixels may be off at any depth (0.01)")
            ->type_name("NUMBER"),
        command.add_flag("--half", o.half,
                         "Write the colour of EXR files, and layers that it does not harm, in half "
                         "precision"),
        command.add_flag("--multipart", o.multipart,
                         "Write each layer of EXR files as a part of its own"),
        command.add_option("--display", o.display, "OpenColorIO display of pictures (all but EXR)")
            ->type_name("NAME"),
        command.add_option("--view", o.view, "OpenColorIO view of pictures")->type_name("NAME"),
        command
            .add_option("--look", o.look,
                        "OpenColorIO look of pictures, instead of the view's own. The word none "
                        "takes no look")
            ->type_name("NAME"),
        addParsed(
            command, "--exposure", o.exposure,
            [](const std::string& text) { return parseNumber(text, -100, 100); },
            "Make pictures brighter by this many stops, such as +1 or -0.5, in place of those that "
            "are chosen")
            ->type_name("NUMBER"),
        command
            .add_option("--ocio", o.ocio,
                        "OpenColorIO config. Without it: the scene's, then that of $OCIO, then the "
                        "one that comes with Woodcock")
            ->type_name("FILE"),
        addMkdir(command, o.mkdir),
        addFrames(
            command, o.frames,
            "Draw these frames, such as 1-48 or 1-48x2,60. Their numbers replace the #### (or "
            "%04d, $F4, <frame04>) in the names of volumes, of files in the scene, and of "
            "outputs"),
        addSkipExisting(command, o.skipExisting)};
    for (CLI::Option* option : options) option->group("Output");
}

void addRendering(CLI::App& command, RenderOptions& o) {
    std::vector<std::string> qualities(scene::qualityNames.begin(), scene::qualityNames.end());
    qualities.push_back("auto");
    std::vector<CLI::Option*> options{
        addChoice(command, "--quality", o.quality, qualities,
                  "How to weigh accuracy against speed, instead of what the scene says. auto "
                  "measures what is best for --time-limit or --noise:")
            ->type_name("QUALITY"),
        addParsed(command, "--res", o.size, parseImageSize,
                  "Image size; a width alone keeps the scene's shape")
            ->type_name("WIDTHxHEIGHT"),
        addParsed(command, "--crop", o.crop, parsePixelRectangle,
                  "Render only the pixels from X0,Y0 up to but without X1,Y1. y points down")
            ->type_name("X0,Y0,X1,Y1"),
        addCount(command, "--spp", o.spp, 1, INT_MAX,
                 "Samples per pixel. Adaptive renders do the same work, but with another number in "
                 "each pixel"),
        addParsed(command, "--samples", o.samples, parseSampleRange,
                  "Draw only the samples FIRST to END - 1 of each pixel. woodcock merge puts such "
                  "parts together")
            ->type_name("FIRST:END"),
        addParsed(command, "--tile", o.tile, parseTileNumber,
                  "Render only one of COUNT tiles of the picture. INDEX goes from 0 to COUNT - 1. "
                  "woodcock merge puts tiles together")
            ->type_name("INDEX/COUNT"),
        command.add_flag("--mergeable", o.mergeable,
                         "Keep the sums in EXR files, so that woodcock merge can add pictures of "
                         "several seeds. --samples and --tile do so anyway"),
        addParsed(command, "--checkpoint", o.checkpoint, parseDuration,
                  "Every so often, such as 60s or 0.1h, write NAME.checkpoint.exr beside the first "
                  "output, from which --resume goes on. SIGUSR1 writes one at once. It disappears "
                  "when the picture is done")
            ->type_name("TIME"),
        command.add_flag("--resume", o.resume,
                         "Go on from NAME.checkpoint.exr, where there is one, to the same picture"),
        addCount(command, "--seed", o.seed, 0, INT64_MAX,
                 "Seed of the random numbers. Another seed gives other noise (0)"),
        addParsed(command, "--time-limit", o.timeLimit, parseDuration,
                  "Stop after this time, such as 90s, 5m or 2h")
            ->type_name("TIME"),
        addParsed(command, "--noise", o.noise, parseFraction,
                  "Stop when the noise is below this, such as 1%. Noise is the relative standard "
                  "error of the picture without its plain background")
            ->type_name("FRACTION"),
        command.add_flag_function(
            "--adaptive,!--no-adaptive", [&o](std::int64_t times) { o.adaptive = times > 0; },
            "Spend the same time, but take more samples where the error is larger and fewer "
            "elsewhere"),
        command.add_flag_function(
            "--denoise,!--no-denoise", [&o](std::int64_t times) { o.denoise = times > 0; },
            "Denoise the picture by Open Image Denoise, which 'pip install pyoidn' brings. EXR "
            "files keep the noisy picture beside it. " +
                denoise::searchText()),
        addCount(command, "--threads", o.threads, 0, 4096,
                 "How many processor threads to use. 0 takes all cores"),
        command.add_flag("--estimate", o.estimate,
                         "Say how long it would take, and how much memory, from a few samples. "
                         "Writes no picture")};
    for (CLI::Option* option : options) option->group("Rendering");
}

/// "0.5" or "-0.25,0.25", as the scene file has it.
std::string parseShutter(const std::string& text) {
    constexpr double longest = 1000;  // frames
    const auto comma = text.find(',');
    if (comma == std::string::npos) return fmt::format("{}", parseNumber(text, 0, longest));
    const double open = parseNumber(text.substr(0, comma), -longest, longest);
    const double close = parseNumber(text.substr(comma + 1), -longest, longest);
    if (close < open)
        throw usageError("'{}' closes before it opens; expected OPEN,CLOSE such as -0.25,0.25",
                         text);
    return fmt::format("[{}, {}]", open, close);
}

void addScene(CLI::App& command, RenderOptions& o) {
    std::vector<CLI::Option*> options{
        addList(command, "--set", o.overrides,
                "Set a value of the scene, such as volume[0].scale=2")
            ->type_name("KEY=VALUE"),
        addParsed(command, "--sun", o.sun, parseAngles,
                  "Where the sun stands, in degrees: its height above the horizon, and its "
                  "direction, clockwise as seen from above")
            ->type_name("ELEVATION,AZIMUTH"),
        addParsed(
            command, "--orbit", o.orbit,
            [](const std::string& text) { return parseNumber(text, -1e6, 1e6); },
            "Turn the camera to its right around what it looks at, for turntables. A camera that "
            "Woodcock chooses then stands far enough for all sides")
            ->type_name("DEGREES"),
        addParsed(
            command, "--frame", o.frame,
            [](const std::string& text) { return parseNumber(text, -1e9, 1e9); },
            "Draw the scene at this frame: its animated values, and the files of sequences. It may "
            "lie between two frames; default 0")
            ->type_name("FRAME"),
        addParsed(command, "--shutter", o.shutter, parseShutter,
                  "For how many frames the shutter is open, around the frame: 0.5 for 180 degrees. "
                  "Or when it opens and closes, in frames after that frame")
            ->type_name("LENGTH|OPEN,CLOSE"),
        addOverlay(command, o.overlay),
        command.add_flag(
            "--plain", o.plain,
            "Choose plain lights, thin smoke and no exposure, for comparisons. Without "
            "it, what the scene leaves open is chosen for a picture to show"),
        command
            .add_option("--write-scene", o.writeScene,
                        "Save the scene with all values that Woodcock chose. Renders only if you "
                        "give -o, too. - is stdout")
            ->type_name("FILE"),
        command.add_flag("--repair", o.repair,
                         "Set NaN, infinite and negative voxels to zero instead of stopping"),
        addEnum(command, "--storage", o.storage, grid::storageNames,
                "Precision of voxels in memory:")
            ->type_name("KIND")};
    for (CLI::Option* option : options) option->group("Scene");
}

void addReports(CLI::App& command, RenderOptions& o) {
    o.reports.addTo(command, "Print counts, times and the files as a JSON object on stdout");
    command.add_option("--stats", o.stats, "Write what --json prints to a file. - is stdout")
        ->type_name("FILE")
        ->group("Reports");
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

void refuseRepeated(const char* option, const std::vector<std::string>& words) {
    for (auto word = words.begin(); word != words.end(); ++word)
        if (std::find(words.begin(), word, *word) != word)
            throw usageError("{} names '{}' twice", option, *word);
}

}  // namespace

void RenderOptions::addTo(CLI::App& command) {
    command.footer(
        examplesText({"woodcock render smoke.vdb -o smoke.png --res 640 --spp 64",
                      "woodcock render scene.toml -o scene.exr --noise 1% "
                      "--time-limit 10m",
                      "woodcock render smoke.####.vdb --frames 1-48 -o smoke.####.png"}));
    command.add_option("INPUT", inputs, "A scene (.toml), or one or more volumes (.vdb, .nvdb)")
        ->required()
        ->type_name("FILE");
    addOutput(command, *this);
    addRendering(command, *this);
    addScene(command, *this);
    addReports(command, *this);
}

SceneInput RenderOptions::sceneInput() const {
    SceneInput input{inputs, overrides, size, sun, choicesLook(), {}, overlay, takesFrames()};
    input.frame = frame;
    if (orbit) input.overrides.push_back(fmt::format("camera.orbit={}", *orbit));
    if (!shutter.empty()) input.overrides.push_back("camera.shutter=" + shutter);
    if (quality && !choosesQuality())
        input.overrides.insert(input.overrides.begin(), "render.quality=" + *quality);
    return input;
}

bool RenderOptions::leavesSamplesOpen(const scene::SceneDescription& scene) const {
    if (plain || isSceneFile(inputs.front())) return false;
    if (spp || samples || timeLimit || noise || adaptive || quality) return false;
    const scene::RenderDescription& render = scene.render;
    const auto isOpen = [&](const auto& member) {
        return scene::findPlace(scene.places, "render." + scene::keyName(render, member)).empty();
    };
    return isOpen(render.spp) && isOpen(render.timeLimit) && isOpen(render.noise) &&
           isOpen(render.adaptive) && scene::findPlace(scene.places, "render.quality").empty();
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
    exclude(frame.has_value(), !frames.empty(), "--frame and --frames");
    exclude(estimate, choosesQuality(), "--estimate and --quality auto");
    exclude(estimate, !writeScene.empty(), "--estimate and --write-scene");
    exclude(estimate, !stats.empty(), "--estimate and --stats");
    exclude(choosesQuality(), resume, "--quality auto and --resume");
    exclude(reports.json, stats == "-", "--json and --stats -");
    exclude(reports.json, writeScene == "-", "--json and --write-scene -");
    if (reports.progress == "alfred" || reports.progress == "openjd")
        for (const auto& [file, name] :
             {std::pair(stats, "--stats"), {writeScene, "--write-scene"}})
            if (file == "-")
                throw usageError("{} - and --progress {} both print on stdout; give one of them",
                                 name, reports.progress);
    if (!frames.empty()) {
        if (std::none_of(inputs.begin(), inputs.end(), isSceneFile)) checkFrameInputs(inputs);
        for (const std::filesystem::path& output : outputs)
            checkFrameOutput(output, "--output", frames);
        if (!rendersImages())
            throw usageError(
                "--frames: --write-scene saves one scene for all frames; leave it out");
    }
    scene::inPlace("--layers", [&] { image::parseLayerNames(layers); });
    refuseRepeated("--mattes", mattes);
    if ((checkpoint || resume) && !rendersImages())
        throw usageError(
            "{} is for a render, but --write-scene only saves the scene where no -o names an image",
            resume ? "--resume" : "--checkpoint");
    if ((!stats.empty() || reports.json) && !rendersImages())
        throw usageError(
            "{} tells of a render, but --write-scene only saves the scene where no -o names an "
            "image",
            reports.json ? "--json" : "--stats");
}

void RenderOptions::checkFor(const std::vector<std::filesystem::path>& files) const {
    const bool exr = std::any_of(files.begin(), files.end(), isExrFile);
    const bool picture = !std::all_of(files.begin(), files.end(), isExrFile);
    constexpr const char* pictures = "PNG, JPEG, TIFF and WebP";
    demandFile(!layers.empty(), "--layers", "EXR", exr);
    demandFile(!mattes.empty() && mattesFile.empty(), "--mattes", "EXR", exr);
    demandFile(half, "--half", "EXR", exr);
    demandFile(mergeable, "--mergeable", "EXR", exr);
    demandFile(multipart, "--multipart", "EXR", exr);
    demandFile(display.has_value(), "--display", pictures, picture);
    demandFile(view.has_value(), "--view", pictures, picture);
    demandFile(look.has_value(), "--look", pictures, picture);
    demandFile(exposure.has_value(), "--exposure", pictures, picture);
}

}  // namespace woodcock::tool
