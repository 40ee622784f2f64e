// SPDX-License-Identifier: Apache-2.0
#include "tools/farm/submit.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <climits>

#include "tools/common/child_process.h"
#include "tools/common/frames.h"
#include "tools/common/interrupt.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/farm/slurm.h"
#include "tools/render/frame_reader.h"
#include "tools/render/prepare.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/image/layers.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool::farm {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Options of a render that the farm gives itself, or that no farm can have.
constexpr std::array notHere{"--samples",  "--tile",        "--mergeable", "--resume",
                             "--estimate", "--write-scene", "--stats",     "--progress"};
/// Options of a render that do not go into its scene.
constexpr std::array besideTheScene{"--help",   "--output",    "--frames", "--skip-existing",
                                    "--mkdir",  "--threads",   "--crop",   "--checkpoint",
                                    "--json",   "--log-level", "--quiet",  "--adaptive",
                                    "--denoise"};

void addJobOptions(CLI::App& command, SubmitOptions& o) {
    const std::vector<CLI::Option*> options{
        command
            .add_option("--job", o.folder,
                        "The job's folder, which must not exist, where every machine sees it "
                        "(INPUT.farm)")
            ->type_name("FOLDER"),
        addCount(command, "--parts", o.parts, 1, 4096,
                 "Draw each picture in so many parts, which share out its samples (1)"),
        addCount(command, "--retries", o.retries, 0, 1000,
                 "Repeat a part that fails or is killed so often (3). What is wrong in the input "
                 "is not repeated"),
        command.add_flag("--keep-parts", o.keepParts, "Keep the parts of pictures that are merged"),
        command.add_option("--program", o.program, "The woodcock that draws, on all machines")
            ->type_name("FILE"),
        command.add_flag("--dry-run", o.dryRun,
                         "Write the job's folder, and submit nothing: for GNU parallel and other "
                         "farms, or to look at")};
    for (CLI::Option* option : options) option->group("Job");
}

void addSlurmOptions(CLI::App& command, SubmitOptions& o) {
    const std::vector<CLI::Option*> options{
        command.add_option("--partition", o.partition, "Where to run")->type_name("NAME"),
        command.add_option("--account", o.account, "Who pays")->type_name("NAME"),
        command
            .add_option("--time", o.time,
                        "Limit of a task, such as 2:00:00. It writes a checkpoint a minute before, "
                        "and goes on in the queue")
            ->type_name("TIME"),
        command.add_option("--memory", o.memory, "Memory of a task, such as 8G")->type_name("SIZE"),
        addCount(command, "--cpus", o.cpus, 1, 4096, "Processors, and threads, of a task"),
        addCount(command, "--at-once", o.atOnce, 1, INT_MAX,
                 "Run so many elements of the array at once, at most"),
        addCount(command, "--tasks-per-element", o.tasksPerElement, 1, INT_MAX,
                 "Do so many parts in one element of the array, at least (1). More, where an array "
                 "may not have so many elements"),
        addList(command, "--sbatch", o.sbatch,
                "A further option of sbatch, as in --sbatch=--qos=night")
            ->type_name("OPTION")};
    for (CLI::Option* option : options) option->group("Slurm");
}

/// "--output" of -o,--output.
std::string longName(const CLI::Option& option) {
    return option.get_lnames().empty() ? "" : "--" + option.get_lnames().front();
}

/// The words by which another render makes the same scene.
Words sceneWords(const SubmitOptions& options, const CLI::App& command) {
    Words words;
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = longName(*option);
        const std::string& group = option->get_group();
        if (option->count() == 0 || name.empty() || group == "Job" || group == "Slurm" ||
            std::find(besideTheScene.begin(), besideTheScene.end(), name) != besideTheScene.end())
            continue;
        if (option->get_items_expected_max() == 0)
            words.push_back(name);
        else
            for (const std::string& value : option->results()) words.push_back(name + "=" + value);
    }
    words.push_back("--no-denoise");  // of parts
    if (const auto adaptive = options.render.adaptive)
        words.push_back(*adaptive ? "--adaptive" : "--no-adaptive");
    return words;
}

/// "smoke.farm" of smoke.toml and of smoke.####.vdb.
fs::path folderFor(const fs::path& input) {
    std::string name = input.stem().string();
    if (const std::string pattern = framePattern(name); !pattern.empty())
        name = name.substr(0, name.find(pattern));
    while (!name.empty() && (name.back() == '.' || name.back() == '_')) name.pop_back();
    return (name.empty() ? "job" : name) + ".farm";
}

void checkFolder(const fs::path& folder) {
    const std::string name = folder.string();
    if (withFrame(name, 1) != name || name.find_first_of("\"\\%$`\n\r\t") != name.npos)
        throw usageError(
            "--job: '{}' holds a sign that Slurm or frames' numbers would change; take letters, "
            "digits, '.', '_' and '-'",
            name);
    std::error_code none;
    if (fs::exists(folder, none))
        throw usageError(
            "--job: '{}' is there already, and is not written over. woodcock farm resubmit goes on "
            "with it; another --job, or its removal, begins anew",
            name);
}

/// An option of sbatch as a script has it.
std::string sbatchOption(const std::string& option) {
    if (!option.starts_with("--") || option.find_first_of("\"\n\r") != option.npos)
        throw usageError("--sbatch: '{}' is no option; give one as in --sbatch=--qos=night",
                         option);
    const auto equals = option.find('=');
    if (option.find(' ') == option.npos || equals == option.npos) return option;
    return fmt::format("{}=\"{}\"", option.substr(0, equals), option.substr(equals + 1));
}

Words sbatchOptions(const SubmitOptions& o) {
    Words given;
    const auto add = [&given](const char* name, const std::string& value) {
        if (!value.empty()) given.push_back(fmt::format("{}={}", name, value));
    };
    add("--partition", o.partition);
    add("--account", o.account);
    add("--time", o.time);
    add("--mem", o.memory);
    if (o.cpus) add("--cpus-per-task", std::to_string(*o.cpus));
    given.insert(given.end(), o.sbatch.begin(), o.sbatch.end());
    Words options;
    for (const std::string& option : given) options.push_back(sbatchOption(option));
    return options;
}

bool hasOwnScenes(const RenderOptions& o) {
    return !o.frames.empty() && isSceneFile(o.inputs.front()) &&
           namesFrame(o.inputs.front().string());
}

/// What is wrong in the same way for all frames.
void checkScene(const scene::SceneDescription& scene, const RenderOptions& o) {
    const scene::OutputDescription& output = scene.output;
    if (output.files.empty())
        throw usageError("there is no output; name a file with -o, such as -o smoke.####.exr");
    o.checkFor(output.files);
    for (std::size_t i = 0; i < output.files.size(); ++i)
        checkFrameOutput(output.files[i],
                         scene::findPlace(scene.places, fmt::format("output.files[{}]", i)),
                         o.frames);
    for (const fs::path* file : {&output.mattesFile, &output.deep})
        if (!file->empty()) checkFrameOutput(*file, placeOfLayerFile(scene, *file), o.frames);
    checkCompositing(scene, o);
    if (scene.render.denoise == scene::Denoise::Always &&
        !image::needsOf(scene::outputLayers(scene)).features)
        throw usageError(
            "--denoise: merged pictures are denoised by their layers albedo and normal; give "
            "--layers albedo,normal");
}

/// What the parts share out, once nothing is open any more.
void shareOut(Job& job, const scene::RenderDescription& render) {
    job.samples = render.spp;
    job.seed = render.seed;
    job.adaptive = scene::renderSettings(render).adaptive;
    job.endsEarly = render.noise > 0 || render.timeLimit > 0;
    if (job.parts > job.samples)
        throw usageError("--parts: {} parts cannot share out {} samples per pixel; give --spp {}",
                         job.parts, job.samples, job.parts);
    if (job.parts > 1 && job.endsEarly)
        throw usageError(
            "--parts: a limit of {0} is for a whole picture, and each of {1} parts would have it "
            "for itself; give --parts 1, or leave it out (--set render.{0}=0)",
            render.noise > 0 ? "noise" : "time_limit", job.parts);
}

/// Whatever a frame needs is there, and its outputs can be written.
void checkFrame(scene::SceneDescription scene, const RenderOptions& o, const std::string& where) {
    for (const fs::path* file : scene::sceneFiles(scene)) {
        std::error_code none;
        if (!file->empty() && !fs::exists(*file, none))
            throw inputError("{}there is no file '{}'", where, file->string());
    }
    checkFiles(scene, o);
    prepareOutputs(scene, o);
}

/// The frames to draw; throws where a frame's files are missing.
std::vector<int> checkFrames(const scene::SceneDescription& scene, const RenderOptions& o) {
    if (o.frames.empty()) {
        if (o.skipExisting && allExist(scene.output.files))
            throw usageError("{} is there already: nothing to submit",
                             scene.output.files.front().string());
        checkFrame(scene, o, "");
        return {0};
    }
    FrameReader reader(scene, o.choicesLook());
    if (hasOwnScenes(o))
        reader =
            FrameReader(scene, o.choicesLook(), [&](int frame) { return describeScene(o, frame); });
    const FramePlan plan = planFrames(o.frames, reader, o.skipExisting);
    if (!plan.without.empty()) {
        const auto& [error, frames] = plan.without.front();
        throw inputError(
            "frame{} {}: {}{}", frames.size() == 1 ? "" : "s", frameRangeText(frames), error,
            plan.without.size() == 1 ? ""
                                     : fmt::format("; {} frames of {} are without files",
                                                   plan.failed().size(), o.frames.size()));
    }
    if (!plan.skipped.empty())
        spdlog::info("left out, as they are there: frames {}", frameRangeText(plan.skipped));
    if (plan.drawn.empty()) throw usageError("all frames are there already: nothing to submit");
    for (const int frame : plan.drawn)
        checkFrame(reader.at(frame), o, fmt::format("frame {}: ", frame));
    return plan.drawn;
}

/// Empty for none.
std::string absoluteOutput(const fs::path& output, bool sequence) {
    if (output.empty()) return "";
    const std::string file = fs::absolute(output).lexically_normal().string();
    const std::string filled = withFrame(output.string(), 1);
    if (sequence && withFrame(file, 1) != fs::absolute(filled).lexically_normal().string())
        throw usageError("'{}': the name of its folder would be changed by frames' numbers", file);
    return file;
}

/// A folder that is removed again, unless it is kept.
class NewFolder {
public:
    explicit NewFolder(fs::path folder) : folder_(std::move(folder)) {
        prepareFolder(folder_, true, "--job");
        std::error_code error;
        if (!fs::create_directory(folder_, error))
            throw usageError("--job: cannot make '{}': {}", folder_.string(),
                             error ? error.message() : "it is there already");
        for (const char* inner : {"parts", "state", "logs", "slurm"})
            fs::create_directory(folder_ / inner);
    }
    ~NewFolder() {
        std::error_code none;
        if (!kept_) fs::remove_all(folder_, none);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
    void keep() { kept_ = true; }

private:
    fs::path folder_;
    bool kept_ = false;
};

fs::path thisProgram() { return fs::read_symlink("/proc/self/exe"); }

/// A render writes the scene with all that it chooses. Ends as it does where that fails.
void writeSceneFile(const std::vector<fs::path>& inputs, Words words, const fs::path& file,
                    bool quiet) {
    Words command{thisProgram().string(), "render"};
    for (const fs::path& input : inputs) command.push_back(input.string());
    command.insert(command.end(), words.begin(), words.end());
    command.insert(command.end(), {"--write-scene", file.string(), "--progress", "none"});
    if (quiet) command.push_back("--quiet");
    const ChildResult result = runChild(
        command, [](const std::string& line) { printProgress("{}\n", line); },
        [] { return interrupted(); });
    if (result.exitCode != exitDone) endWith(static_cast<ExitCode>(result.exitCode));
}

void writeScenes(Job& job, const SubmitOptions& options, const Words& words) {
    const RenderOptions& o = options.render;
    if (!hasOwnScenes(o)) {
        job.scene = "scene.toml";
        writeSceneFile(o.inputs, words, job.folder / job.scene, o.reports.quiet);
        return;
    }
    job.scene = "scene.####.toml";
    for (const int frame : job.frames)
        writeSceneFile({inFrame(o.inputs.front(), frame)}, words,
                       job.folder / withFrame(job.scene, frame), true);
}

}  // namespace

void SubmitOptions::addTo(CLI::App& command) {
    render.addTo(command);
    for (const char* name : notHere) command.remove_option(command.get_option(name));
    command.get_option("--json")->description(
        "Print the job's folder and numbers as a JSON object on stdout");
    command.get_option("--checkpoint")
        ->description("Write a checkpoint of each part every so often, such as 60s or 0.1h (60s)");
    addJobOptions(command, *this);
    addSlurmOptions(command, *this);
    command.footer(examplesText(
        {"woodcock farm submit shot.toml --frames 1-240 --parts 4 -o smoke.####.exr",
         "woodcock farm submit shot.toml --parts 16 -o big.exr --cpus 8 --time 1:00:00",
         "woodcock farm submit shot.toml --frames 1-48 -o smoke.####.exr --dry-run"}));
}

Job makeJob(const SubmitOptions& options, const CLI::App& command) {
    const RenderOptions& o = options.render;
    o.check();
    if (o.choosesQuality())
        throw usageError("--quality auto measures on one machine; name a quality for a farm");
    Job job;
    job.folder = fs::absolute(options.folder.empty() ? folderFor(o.inputs.front()) : options.folder)
                     .lexically_normal();
    if (!job.folder.has_filename()) job.folder = job.folder.parent_path();
    checkFolder(job.folder);
    job.sbatchOptions = sbatchOptions(options);
    if (!options.dryRun) demandSlurm();

    const scene::SceneDescription scene =
        describeScene(o, hasOwnScenes(o) ? std::optional(o.frames.front()) : std::nullopt);
    checkScene(scene, o);
    job.sequence = !o.frames.empty();
    job.frames = checkFrames(scene, o);
    job.parts = options.parts.value_or(1);
    if (job.frames.size() > static_cast<std::size_t>(mostFrames / job.parts))
        throw usageError("{} frames in {} parts are more than {} tasks; submit several jobs",
                         job.frames.size(), job.parts, mostFrames);
    for (const fs::path& output : scene.output.files)
        job.outputs.push_back(absoluteOutput(output, job.sequence));
    job.mattesFile = absoluteOutput(scene.output.mattesFile, job.sequence);
    job.deepFile = absoluteOutput(scene.output.deep, job.sequence);
    job.denoises = scene.render.denoise == scene::Denoise::Always;
    job.program = options.program.empty() ? thisProgram().string() : options.program;
    job.input = o.inputs.front().string();
    job.checkpoint = o.checkpoint.value_or(job.checkpoint);
    job.retries = options.retries.value_or(job.retries);
    job.keepsParts = options.keepParts;
    job.atOnce = options.atOnce.value_or(0);
    job.tasksPerElement = options.tasksPerElement.value_or(1);
    if (o.threads) job.options.push_back(fmt::format("--threads={}", *o.threads));
    if (o.crop) {
        pictureOf(scene.render, o);  // it lies within
        job.options.push_back(
            fmt::format("--crop={},{},{},{}", o.crop->x0, o.crop->y0, o.crop->x1, o.crop->y1));
    }
    if (isSceneFile(o.inputs.front())) shareOut(job, scene.render);  // before anything is loaded

    NewFolder folder(job.folder);
    writeScenes(job, options, sceneWords(options, command));
    const scene::SceneDescription complete =
        scene::parseScene(job.folder / withFrame(job.scene, job.frames.front()));
    shareOut(job, complete.render);
    if (!hasOwnScenes(o)) job.digest = scene::sceneDigest(complete);
    writeJob(job);
    folder.keep();
    return job;
}

}  // namespace woodcock::tool::farm
