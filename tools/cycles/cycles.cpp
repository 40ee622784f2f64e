// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <array>
#include <climits>
#include <nlohmann/json.hpp>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/progress.h"
#include "tools/common/report_options.h"
#include "tools/common/scene_input.h"
#include "tools/cycles/render.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool {

namespace {

struct Options {
    SceneInput input;
    std::optional<int> spp, threads;
    std::optional<std::uint64_t> seed;
    std::optional<std::string> mode, interpolation;
    std::optional<double> stepRate;
    std::filesystem::path image, blend;
    std::string blender;
    bool mkdir = false;
    ReportOptions reports;
};

void checkOutput(const std::filesystem::path& file, const char* option, const char* extension,
                 bool mkdir) {
    if (file.empty()) return;
    if (file.extension() != extension)
        throw usageError("{} '{}' is no {} file", option, file.string(), extension);
    prepareOutput(file, mkdir, option);
}

void check(const Options& options) {
    checkInput(options.input);
    if (options.image.empty() && options.blend.empty())
        throw usageError(
            "there is no output; name an image with -o, such as -o cycles.exr, or a "
            "file to save the scene in, with --save");
    checkOutput(options.image, "-o", ".exr", options.mkdir);
    checkOutput(options.blend, "--save", ".blend", options.mkdir);
    if (options.stepRate && options.mode == "null")
        throw usageError("--step-rate is for --mode biased, which marches");
}

void run(const Options& options, const std::string& commandLine) {
    const ProgressStyle style = options.reports.start();
    check(options);
    catchInterrupts();
    scene::SceneDescription scene = parseInput(options.input);
    scene.render.spp = options.spp.value_or(scene.render.spp);
    scene.render.seed = options.seed.value_or(scene.render.seed);
    refuseOverwriting(std::array{options.image, options.blend}, filesRead(options.input, scene));
    const scene::LoadedScene loaded = loadAndComplete(scene);

    CyclesOptions cycles;
    cycles.settings.mode = options.mode.value_or("");
    cycles.settings.interpolation = options.interpolation.value_or("");
    cycles.settings.stepRate = options.stepRate.value_or(cycles.settings.stepRate);
    cycles.settings.threads = options.threads.value_or(0);
    cycles.blender = options.blender;
    cycles.image = options.image;
    cycles.blend = options.blend;
    cycles.commandLine = commandLine;
    cycles.shouldStop = interrupted;
    CyclesResult result;
    {
        ProgressBar progress(style, "cycles");
        cycles.onProgress = [&](double fraction) { progress.update(fraction); };
        result = renderWithCycles(scene, loaded, cycles);
    }
    if (result.stopped) {
        spdlog::warn("interrupted: nothing is written");
        endWith(exitInterrupted);
    }
    if (!options.image.empty()) {
        if (result.mode == "biased" && options.mode != "biased")
            spdlog::warn("Blender {} only marches through volumes, which is biased",
                         result.version);
        spdlog::info("Blender {} ({}): {} samples in {:.1f} s", result.version, result.mode,
                     scene.render.spp, result.seconds);
    }
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const auto& file : {options.image, options.blend}) {
        if (file.empty()) continue;
        spdlog::info("wrote {}", file.string());
        files.push_back(file.string());
    }
    if (!options.reports.json) return;
    nlohmann::ordered_json about{{"files", files}, {"blender", result.version}};
    if (!options.image.empty())
        about.update({{"mode", result.mode},
                      {"samples", scene.render.spp},
                      {"seed", scene.render.seed},
                      {"seconds", result.seconds}});
    printJson(about);
}

CLI::App& addTo(CLI::App& app, const std::string& commandLine) {
    CLI::App& command =
        *app.add_subcommand("cycles", "Render a scene with Blender's Cycles, for a comparison");
    const auto o = std::make_shared<Options>();
    command.add_option("INPUT", o->input.files, "A scene (.toml), or one or more volumes (.vdb)")
        ->required()
        ->type_name("FILE");
    addOverlay(command, o->input.overlay);
    command.add_option("-o,--output", o->image, "Image to write")->type_name("FILE.exr");
    command
        .add_option("--save", o->blend,
                    "Save the scene for Blender. Renders only if you give -o, too")
        ->type_name("FILE.blend");
    command
        .add_option("--blender", o->blender,
                    "Blender's program, or a Python with bpy. Without it: $BLENDER, then blender "
                    "on the PATH")
        ->type_name("PROGRAM");
    addMkdir(command, o->mkdir);
    addChoice(command, "--mode", o->mode, {"null", "biased"},
              "How to sample volumes: null-collision tracking (from Blender 5.0 on, and the "
              "default there) or biased ray marching:")
        ->type_name("MODE");
    addChoice(command, "--interpolation", o->interpolation, {"stochastic", "trilinear"},
              "How to read grids: one of eight voxels at random (from Blender 5.0 on, and the "
              "default there), or all eight:")
        ->type_name("KIND");
    addParsed(
        command, "--step-rate", o->stepRate,
        [](const std::string& text) { return parseNumber(text, 1e-3, 100); },
        "For --mode biased: length of a step, as in Blender's step rate, where 1 is a voxel (0.1)")
        ->type_name("NUMBER");
    addParsed(command, "--res", o->input.size, parseImageSize,
              "Image size; a width alone keeps the scene's shape")
        ->type_name("WIDTHxHEIGHT");
    addCount(command, "--spp", o->spp, 1, 16777216, "Samples per pixel");
    addCount(command, "--seed", o->seed, 0, INT64_MAX,
             "Seed of the random numbers. Another seed gives other noise (0)");
    addCount(command, "--threads", o->threads, 0, 1024,
             "How many processor threads to use. 0 takes all cores");
    addList(command, "--set", o->input.overrides,
            "Set a value of the scene, such as volume[0].scale=2")
        ->type_name("KEY=VALUE");
    o->reports.addTo(command, "Print a JSON object about the render, on stdout");
    command.footer(examplesText({"woodcock cycles scene.toml -o cycles.exr --spp 64",
                                 "woodcock cycles scene.toml --save scene.blend"}));
    command.callback([o, commandLine] { run(*o, commandLine); });
    return command;
}

}  // namespace

extern const Command cyclesCommand{&addTo};

}  // namespace woodcock::tool
