// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/bake/frames.h"
#include "tools/bake/preview.h"
#include "tools/bake/preview_sheet.h"
#include "tools/bake/report.h"
#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/frames.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/common/progress.h"
#include "tools/common/report_options.h"
#include "woodcock/bake/bake_file.h"
#include "woodcock/bake/baker.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/base/memory.h"
#include "woodcock/base/parse.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool {

namespace {

namespace fs = std::filesystem;
struct BakeOptions {
    std::string input;
    fs::path output, like, preview, writeRecipe, sheet;
    std::string likeGrid;
    bool list = false, describe = false, half = false, full = false, mkdir = false,
         skipExisting = false;
    ReportOptions reports;
    std::optional<double> voxel, seed, mostVoxels, tolerance;
    FrameOptions frames;
    std::optional<int> resolution, threads, levels;
    std::vector<std::string> settings;
    std::string compression = "blosc";
};

std::vector<std::string> presetNames() {
    std::vector<std::string> names;
    for (const auto& preset : bake::presets()) names.push_back(preset.first);
    return names;
}

fs::path fileOf(const fs::path& file, const BakeFrame& frame) {
    return frame.number ? inFrame(file, *frame.number) : file;
}

/// A preset by its name, a recipe's file, or a VDB file, whose grids are sampled anew.
bake::RecipeText findRecipe(const std::string& input, const BakeFrame& frame) {
    if (const auto preset = bake::presets().find(input); preset != bake::presets().end())
        return {std::string(preset->second), input, ""};
    const fs::path file = fileOf(input, frame);
    if (file.extension() == ".toml") {
        bake::RecipeText text = bake::readRecipe(file);
        text.frame = frame.number;
        return text;
    }
    if (file.extension() == ".vdb" || file.extension() == ".nvdb") return bake::recipeOfGrids(file);
    if (fs::exists(file))
        throw usageError(
            "'{}' is neither a recipe (.toml) nor a volume (.vdb); to convert other "
            "data, see woodcock convert",
            input);
    const std::vector<std::string> names = presetNames();
    throw usageError("there is no preset '{}'{}; a recipe's file ends with .toml", input,
                     suggestName(input, "presets", names));
}

std::vector<bake::ParameterSetting> settingsOf(const BakeOptions& options, const BakeFrame& frame) {
    std::vector<bake::ParameterSetting> settings;
    for (const std::string& text : options.settings) {
        const std::string origin = "--set " + text;
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw usageError("{}: expected NAME=VALUE, as in --set size=3", origin);
        try {
            settings.push_back({text.substr(0, equals),
                                parseNumber(text.substr(equals + 1), -1e300, 1e300), origin});
        } catch (const Error& e) {
            throw usageError("{}: {}", origin, e.what());
        }
    }
    if (options.seed) settings.push_back({"seed", *options.seed, "--seed"});
    if (frame.time)
        settings.push_back({"time", *frame.time, options.frames.time ? "--time" : "--frames"});
    return settings;
}

void printPresets() {
    for (const auto& [name, text] : bake::presets())
        print("{:<20} {}\n", name, bake::recipeAbout({std::string(text), name, ""}));
    print("woodcock bake NAME --describe lists a recipe's parameters.\n");
}

void printParameters(const bake::RecipeText& recipe,
                     const std::vector<bake::ParameterSetting>& settings) {
    print("{}: {}\n", recipe.name, bake::recipeAbout(recipe));
    const bake::ParameterSet set = bake::recipeParameters(recipe, settings);
    for (const bake::Parameter& p : set.all()) {
        const std::string range =
            p.lower ? fmt::format(" [{:g} to {:g}]", *p.lower, *p.upper) : std::string();
        print("  {:<16} {:<10g} {}{}\n", p.name, p.value, p.about, range);
    }
}

/// - is stdout.
void writeRecipe(const fs::path& file, const bake::RecipeText& text) {
    if (file == "-") return printData(text.text);
    refuseOverwriting(std::array{file}, std::array{fs::path(text.name)});
    checkWritable(file);
    writeWholeFile(file, text.text);
    spdlog::info("wrote {}", file.string());
}

/// Nothing that is read may be written over.
void checkFiles(const bake::Recipe& recipe, const BakeOptions& options, const BakeFrame& frame) {
    std::vector<fs::path> read = recipe.files;
    read.insert(read.end(), {fileOf(options.input, frame), fileOf(options.like, frame)});
    std::vector<fs::path> written =
        bake::bakedFiles(fileOf(options.output, frame), options.levels.value_or(0));
    written.push_back(fileOf(options.preview, frame));
    refuseOverwriting(written, read);
}

bake::BakeSettings settingsFor(const bake::Recipe& recipe, const BakeOptions& options,
                               const BakeFrame& frame) {
    bake::BakeSettings settings;
    if (!options.like.empty()) {
        settings.worldFromIndex = bake::transformOf(fileOf(options.like, frame), options.likeGrid);
    } else {
        const Vec3d size = recipe.bounds.size();
        const double longest = std::max({size.x, size.y, size.z});
        const double voxel = options.voxel.value_or(
            (longest > 0 ? longest : 1) / std::max(1, options.resolution.value_or(256) - 1));
        settings = bake::cubicVoxels(voxel);
        if (!options.voxel)
            spdlog::info("voxels of {:.4g} world units: {} along the recipe's longest side", voxel,
                         options.resolution.value_or(256));
    }
    double bytes = 0;  // of a voxel in all grids, with its share of the tree
    for (const bake::RecipeOutput& output : recipe.outputs) bytes += 4.2 * output.channels;
    settings.mostVoxels =
        options.mostVoxels.value_or(static_cast<double>(memoryLimit()) * 0.8 / bytes);
    settings.threads = options.threads.value_or(0);
    return settings;
}

std::string describeParameters(const bake::Recipe& recipe) {
    std::string text;
    for (const bake::Parameter& p : recipe.parameters.all())
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", p.name, tomlNumber(p.value));
    return text;
}

void refuseBeyondHalf(const bake::Bake& bake) {
    for (const bake::BakedGridStatistics& grid : bake.statistics)
        if (std::max(std::abs(grid.least), std::abs(grid.greatest)) > 65504)
            throw inputError(
                "output '{}' has values up to {:g}, and half precision ends at 65504; bake with "
                "--float",
                grid.name, std::max(std::abs(grid.least), grid.greatest));
}

/// Bakes one frame, or what is all there is; the JSON of --json. Nothing where it was interrupted
/// before anything of this frame was written.
std::optional<nlohmann::ordered_json> bakeFrame(const bake::RecipeText& text,
                                                const BakeOptions& options, const BakeFrame& frame,
                                                ProgressStyle style) {
    bake::Recipe recipe = bake::makeRecipe(text, settingsOf(options, frame));
    checkFiles(recipe, options, frame);
    if (options.tolerance)
        for (bake::RecipeOutput& output : recipe.outputs) output.tolerance = *options.tolerance;
    const fs::path volume = fileOf(options.output, frame), preview = fileOf(options.preview, frame);
    if (!preview.empty()) checkPreview(preview, recipe);
    const bake::BakeSettings how = settingsFor(recipe, options, frame);
    std::optional<bake::Bake> bake;
    {
        ProgressBar progress(style, "bake");
        bake = bake::bakeRecipe(recipe, how, [&](double done) {
            progress.update(done);
            return !interrupted();
        });
    }
    if (!bake || interrupted()) return std::nullopt;
    reportBake(*bake);
    grid::VdbWriteOptions writing;
    writing.half = options.half;
    writing.compression = bake::compressionNamed(options.compression);
    writing.metadata = {{"creator", fmt::format("woodcock {} bake", version())},
                        {"recipe", text.name},
                        {"parameters", describeParameters(recipe)}};
    if (options.half) refuseBeyondHalf(*bake);
    const std::vector<fs::path> files =
        bake::writeBake(volume, *bake, writing, options.levels.value_or(0));
    for (const fs::path& file : files)
        spdlog::info("wrote {} ({:.1f} MB)", file.string(),
                     static_cast<double>(bytesOfFile(file)) / 1e6);
    nlohmann::ordered_json json = bakeJson(recipe, *bake, frame, files);
    if (!preview.empty()) {
        if (!writePreview(recipe, *bake, volume, preview, {.threads = how.threads}, style)) {
            spdlog::warn("interrupted in the preview: {} is whole", volume.string());
            endWith(exitInterrupted);
        }
        json["preview"] = preview.string();
    }
    return json;
}

void prepareFiles(const BakeOptions& options, const BakeFrame& frame) {
    for (const fs::path& file : {options.output, options.preview}) {
        if (file.empty()) continue;
        prepareFolder(fileOf(file, frame), options.mkdir);
        checkWritable(fileOf(file, frame));
    }
}

/// The names that are written, checked before the work.
void checkOutputs(const BakeOptions& options, const std::vector<BakeFrame>& frames) {
    if (options.output.empty())
        throw usageError("there is no output; name a file with -o, such as -o {}.vdb",
                         fs::path(options.input).stem().string());
    if (options.output.extension() != ".vdb")
        throw usageError(
            "--output {}: bake writes .vdb files; woodcock convert makes others of them",
            options.output.string());
    std::vector<int> numbers;
    for (const BakeFrame& frame : frames)
        if (frame.number) numbers.push_back(*frame.number);
    checkFrameOutput(options.output, "--output", numbers);
    if (!options.preview.empty()) checkFrameOutput(options.preview, "--preview", numbers);
    prepareFiles(options, frames.front());
}

void makeSheet(const BakeOptions& options, ProgressStyle style) {
    if (!options.input.empty() || !options.output.empty())
        throw usageError("--sheet shows all presets; it goes without a recipe and -o");
    checkSheet(options.sheet);
    catchInterrupts();
    SheetSettings settings;
    settings.resolution = options.resolution.value_or(settings.resolution);
    settings.threads = options.threads.value_or(0);
    if (writeSheet(options.sheet, settings, style)) {
        if (options.reports.json)
            printJson(nlohmann::ordered_json{{"sheet", options.sheet.string()},
                                             {"presets", presetNames()}});
        return;
    }
    spdlog::warn("interrupted: nothing is written");
    endWith(exitInterrupted);
}

std::vector<fs::path> filesOf(const BakeOptions& options, const BakeFrame& frame) {
    std::vector<fs::path> files =
        bake::bakedFiles(fileOf(options.output, frame), options.levels.value_or(0));
    if (!options.preview.empty()) files.push_back(fileOf(options.preview, frame));
    return files;
}

void makeFrames(const BakeOptions& options, const std::vector<BakeFrame>& frames,
                ProgressStyle style) {
    using Json = nlohmann::ordered_json;
    Json all = Json::array();
    std::map<int, BakeFrame> byNumber;
    std::vector<int> made, skipped;
    for (const BakeFrame& frame : frames) {
        byNumber[*frame.number] = frame;
        const bool skip = options.skipExisting && allExist(filesOf(options, frame));
        (skip ? skipped : made).push_back(*frame.number);
    }
    if (!skipped.empty())
        spdlog::info("frame{} {}: there already", skipped.size() == 1 ? "" : "s",
                     frameRangeText(skipped));
    const FrameReport report = forEachFrame(made, [&](int number) {
        const BakeFrame& frame = byNumber[number];
        spdlog::info("frame {} of {}: time {:g}", number, frameRangeText(made), *frame.time);
        prepareFiles(options, frame);
        std::optional<Json> json =
            bakeFrame(findRecipe(options.input, frame), options, frame, style);
        if (!json) return exitInterrupted;
        all.push_back(std::move(*json));
        return exitDone;
    });
    if (options.reports.json)
        printJson(Json{{"frames", all}, {"failed", report.failed}, {"skipped", skipped}});
    endUnlessDone(report);
}

void run(const BakeOptions& options) {
    const ProgressStyle style = options.reports.start();
    if (options.list) return printPresets();
    if (!options.sheet.empty()) return makeSheet(options, style);
    if (options.input.empty())
        throw usageError("name a preset ({}), a recipe (.toml) or a volume (.vdb)",
                         joinNames(presetNames()));
    const std::vector<BakeFrame> frames = bakeFrames(options.frames);
    const bake::RecipeText text = findRecipe(options.input, frames.front());
    if (options.describe) return printParameters(text, settingsOf(options, frames.front()));
    if (!options.writeRecipe.empty()) {
        if (options.writeRecipe != "-") prepareFolder(options.writeRecipe, options.mkdir);
        writeRecipe(options.writeRecipe, text);
        if (options.output.empty()) return;
    }
    checkOutputs(options, frames);
    catchInterrupts();

    if (frames.front().number) return makeFrames(options, frames, style);
    const BakeFrame& only = frames.front();
    if (options.skipExisting && allExist(filesOf(options, only)))
        return spdlog::info("{} is there already: nothing to do", options.output.string());
    const auto json = bakeFrame(text, options, only, style);
    if (!json) {
        spdlog::warn("interrupted: nothing is written");
        endWith(exitInterrupted);
    }
    if (options.reports.json) printJson(*json);
}

CLI::App& addTo(CLI::App& app, const std::string&) {
    CLI::App& command = *app.add_subcommand(
        "bake", "Make a VDB file from a recipe: clouds, smoke, fire and other procedural volumes");
    const auto o = std::make_shared<BakeOptions>();
    const auto number = [&](const char* name, std::optional<double>& value, double lowest,
                            double highest, const char* help) {
        addParsed(
            command, name, value,
            [=](const std::string& text) { return parseNumber(text, lowest, highest); }, help)
            ->type_name("NUMBER");
    };
    command
        .add_option("INPUT", o->input,
                    "A preset's name, a recipe (.toml), or a volume (.vdb) to resample")
        ->type_name("RECIPE");
    command.add_option("-o,--output", o->output, "The volume to write")->type_name("FILE.vdb");
    addMkdir(command, o->mkdir);
    command.add_flag("--list", o->list, "List the presets");
    command.add_flag("--describe", o->describe, "List the recipe's parameters");
    command
        .add_option(
            "--write-recipe", o->writeRecipe,
            "Save the recipe's text for you to edit. Bakes only if you give -o, too. - is stdout")
        ->type_name("FILE.toml");
    command.add_option("--set", o->settings, "Set a parameter of the recipe; may be repeated")
        ->allow_extra_args(false)
        ->type_name("NAME=VALUE");
    number("--seed", o->seed, -9e15, 9e15,
           "Short for --set seed=NUMBER. Another seed gives another shape");
    command
        .add_option("--time", o->frames.time,
                    "Short for --set time=SECONDS. FROM:TO:STEP makes a frame for each of these "
                    "times, numbered from 1")
        ->type_name("SECONDS");
    addFrames(command, o->frames.frames,
              "Make these frames, such as 1-48 or 1-48x2,60. Their numbers replace the #### (or "
              "%04d, $F4, <frame04>) in the names of inputs and outputs");
    addSkipExisting(command, o->skipExisting);
    number("--fps", o->frames.rate, 1e-3, 1e6,
           "Frames per second of --frames (24). Frame 1 is at time 0");
    number("--voxel", o->voxel, 1e-12, 1e12, "Side of a voxel, in world units");
    addCount(command, "--resolution", o->resolution, 1, 1000000,
             "Voxels along the longest side of the recipe's bounds (256)");
    command
        .add_option("--like", o->like,
                    "Put the voxels where this volume has them: its grid's transform is taken")
        ->type_name("FILE.vdb");
    command.add_option("--grid", o->likeGrid, "The grid of --like. Without it: the first")
        ->type_name("NAME");
    number(
        "--tolerance", o->tolerance, 0, 1e30,
        "Leave out values this near to zero, and merge equal ones. Without it: the recipe's own");
    addCount(
        command, "--lod", o->levels, 0, 16,
        "Write this many coarser files, too: FILE.lod1.vdb has voxels twice as large, and so on");
    CLI::Option* half = command.add_flag("--half", o->half, "Save values in half precision");
    command.add_flag("--float", o->full, "Save values in single precision (the default)")
        ->excludes(half);
    addChoice(command, "--compression", o->compression, {"none", "zip", "blosc"},
              "How to compress the file:")
        ->type_name("WORD");
    command
        .add_option("--preview", o->preview,
                    "Render a small picture of it, too, in a second or two: PNG, JPEG or EXR")
        ->type_name("FILE");
    command.add_option("--sheet", o->sheet, "Only make a picture of all presets: PNG or JPEG")
        ->type_name("FILE");
    number("--max-voxels", o->mostVoxels, 1, 1e15,
           "Refuse to evaluate more voxels than this. Without it: as many as fit into memory");
    addCount(command, "--threads", o->threads, 1, 1024,
             "How many processor threads to use. Without it: all cores");
    o->reports.addTo(command, "Print a JSON object about the files that are written, on stdout");
    command.footer(examplesText({"woodcock bake cumulus -o cumulus.vdb --preview cumulus.png",
                                 "woodcock bake explosion -o explosion.####.vdb --frames 1-48"}));
    command.callback([o] { run(*o); });
    return command;
}

}  // namespace

extern const Command bakeCommand{&addTo};

}  // namespace woodcock::tool
