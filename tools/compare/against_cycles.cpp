// SPDX-License-Identifier: Apache-2.0
#include "tools/compare/against_cycles.h"

#include <spdlog/spdlog.h>

#include "tools/common/exit_codes.h"
#include "tools/common/interrupt.h"
#include "tools/common/progress.h"
#include "tools/cycles/render.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/outputs.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

constexpr int fewestSeeds = 2;

[[noreturn]] void stop() {
    spdlog::warn("interrupted: nothing is compared");
    endWith(exitInterrupted);
}

double renderOurs(const render::Scene& scene, const scene::SceneDescription& description,
                  const std::filesystem::path& file, const std::string& commandLine,
                  ProgressStyle style) {
    image::OutputSettings outputSettings;
    outputSettings.files = {file};
    outputSettings.layers = image::layersFromNames({"error"});
    const image::Outputs outputs(std::move(outputSettings));
    const render::RenderSettings settings = scene::renderSettings(description.render);
    const render::RenderResult result = renderWithProgress(scene, settings, style);
    if (result.reason == render::StopReason::Interrupted) stop();
    outputs.write(result.film, {0, result.endSample, settings.seed, result.seconds,
                                scene::sceneDigest(description), commandLine});
    return result.seconds;
}

std::filesystem::path pictureOf(const std::filesystem::path& directory, const char* program,
                                int seed) {
    return directory / (program + (seed == 0 ? ".exr" : fmt::format("_{}.exr", seed + 1)));
}

std::vector<std::filesystem::path> picturesOf(const std::filesystem::path& directory, int seeds) {
    std::vector<std::filesystem::path> files;
    for (int i = 0; i < seeds; ++i)
        for (const char* program : {"woodcock", "cycles"})
            files.push_back(pictureOf(directory, program, i));
    return files;
}

CyclesResult renderTheirs(const scene::SceneDescription& description,
                          const scene::LoadedScene& loaded, const BothOptions& o,
                          const std::filesystem::path& file, const std::string& commandLine,
                          ProgressStyle style) {
    CyclesOptions cycles;
    cycles.settings.mode = o.mode.value_or("");
    cycles.settings.interpolation = o.interpolation.value_or("");
    cycles.settings.stepRate = o.stepRate.value_or(cycles.settings.stepRate);
    cycles.blender = o.blender;
    cycles.image = file;
    cycles.commandLine = commandLine;
    cycles.shouldStop = interrupted;
    ProgressBar progress(style, "cycles");
    cycles.onProgress = [&](double fraction) { progress.update(fraction); };
    CyclesResult result = renderWithCycles(description, loaded, cycles);
    if (result.stopped) stop();
    return result;
}

}  // namespace

std::vector<compare::PictureSource> renderBoth(const BothOptions& o,
                                               const std::filesystem::path& directory,
                                               const std::string& commandLine,
                                               ProgressStyle style) {
    catchInterrupts();
    checkInput(o.input);
    scene::SceneDescription description = parseInput(o.input);
    description.render.spp = o.spp.value_or(description.render.spp);
    const int seeds = o.seeds.value_or(fewestSeeds);
    refuseOverwriting(picturesOf(directory, seeds), filesRead(o.input, description));
    const scene::LoadedScene loaded = loadAndComplete(description);
    const render::Scene scene = scene::buildScene(description, loaded);

    std::vector<compare::PictureSource> sources(2);
    double ours = 0, theirs = 0;
    CyclesResult last;
    const std::uint64_t firstSeed = description.render.seed;
    for (int i = 0; i < seeds; ++i) {
        description.render.seed = firstSeed + static_cast<std::uint64_t>(i);
        const auto a = pictureOf(directory, "woodcock", i), b = pictureOf(directory, "cycles", i);
        // Cycles first: what it cannot express, or a Blender that is not there, is known at once.
        last = renderTheirs(description, loaded, o, b, commandLine, style);
        theirs += last.seconds;
        ours += renderOurs(scene, description, a, commandLine, style);
        if (i == 0) {
            sources[0].file = a, sources[1].file = b;
        } else {
            sources[0].more.push_back(a), sources[1].more.push_back(b);
        }
    }
    spdlog::info("A: Woodcock, {:.1f} s; B: Cycles of Blender {} ({}), {:.1f} s; {} x {} samples",
                 ours, last.version, last.mode, theirs, seeds, description.render.spp);
    if (last.mode == "biased" && o.mode != "biased")
        spdlog::warn("Blender {} only marches through volumes, which is biased", last.version);
    return sources;
}

}  // namespace woodcock::tool
