// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/render.h"

#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/common/child_process.h"
#include "tools/cycles/blender.h"
#include "tools/cycles/lights.h"
#include "tools/cycles/surfaces.h"
#include "woodcock/base/error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

extern const std::string_view blenderRenderInCycles, blenderCyclesNodes, blenderCyclesVolumes,
    blenderCyclesLights, blenderCyclesSurfaces, blenderCyclesMotion, blenderMapping;

namespace {

namespace fs = std::filesystem;

void writeScripts(const TempDir& directory) {
    const std::pair<const char*, std::string_view> scripts[] = {
        {"render_in_cycles.py", blenderRenderInCycles},
        {"cycles_nodes.py", blenderCyclesNodes},
        {"cycles_volumes.py", blenderCyclesVolumes},
        {"cycles_lights.py", blenderCyclesLights},
        {"cycles_surfaces.py", blenderCyclesSurfaces},
        {"cycles_motion.py", blenderCyclesMotion},
        {"mapping.py", blenderMapping}};
    for (const auto& [name, text] : scripts) writeWholeFile(directory / name, text);
}

/// Of Blender's line "... | Sample 12/64": 12/64.
std::optional<double> fractionIn(const std::string& line) {
    const std::size_t at = line.rfind("Sample ");
    if (at == std::string::npos) return std::nullopt;
    const char *text = line.data() + at + 7, *end = line.data() + line.size();
    double done = 0, all = 0;
    const auto [slash, problem] = std::from_chars(text, end, done);
    if (problem != std::errc() || slash == end || *slash != '/') return std::nullopt;
    if (std::from_chars(slash + 1, end, all).ec != std::errc() || !(all > 0)) return std::nullopt;
    return done / all;
}

Error blenderFailed(const Blender& blender, const ChildResult& child) {
    const bool noModule = blender.isPython &&
                          fmt::format("{}", fmt::join(child.lastLines, "\n")).find("named 'bpy'") !=
                              std::string::npos;
    if (noModule)
        return usageError("'{}' ({}) has no module bpy; pip install bpy, or name another program",
                          blender.program, blender.version);
    return failure("'{}' ({}) failed with exit code {}; its last words:\n{}", blender.program,
                   blender.version, child.exitCode, fmt::join(child.lastLines, "\n"));
}

nlohmann::json readResult(const fs::path& file) {
    std::ifstream in(file);
    return nlohmann::json::parse(in, nullptr, false);
}

void save(const fs::path& made, const fs::path& target) {
    FileInTheMaking file(target);
    fs::copy_file(made, file.temporary(), fs::copy_options::overwrite_existing);
    file.commit();
}

void writeImage(const fs::path& drawn, const scene::SceneDescription& scene,
                const CyclesOptions& options, const CyclesResult& result) {
    std::vector<std::pair<std::string, image::ImageAttribute>> attributes{
        {"Software", fmt::format("Blender {} Cycles, by woodcock {}", result.version, version())},
        {"woodcock/version", std::string(version())},
        {"woodcock/renderer", "cycles"},
        {"woodcock/blender", result.version},
        {"woodcock/cyclesMode", result.mode},
        {"woodcock/cyclesInterpolation", result.interpolation},
        {"woodcock/samples", scene.render.spp},
        {"woodcock/seed", fmt::format("{}", scene.render.seed)},
        {"woodcock/sceneDigest", scene::sceneDigest(scene)},
        {"woodcock/renderSeconds", static_cast<float>(result.seconds)}};
    if (result.mode == "biased")
        attributes.emplace_back("woodcock/cyclesStepRate",
                                static_cast<float>(options.settings.stepRate));
    if (!options.commandLine.empty())
        attributes.emplace_back("woodcock/commandLine", options.commandLine);
    image::annotateExr(drawn, options.image, attributes);
}

}  // namespace

CyclesResult renderWithCycles(const scene::SceneDescription& scene,
                              const scene::LoadedScene& loaded, const CyclesOptions& options) {
    CyclesSettings settings = options.settings;
    settings.draw = !options.image.empty();
    settings.save = !options.blend.empty();
    const std::string text = cyclesScene(scene, loaded, settings);
    const Blender blender = findBlender(options.blender, options.shouldStop);
    spdlog::debug("{} is {}", blender.program, blender.version);

    const TempDir directory;
    writeScripts(directory);
    writeWholeFile(directory / "scene.json", text);
    writeCyclesMeshes(directory.string(), scene, loaded);
    writeCyclesSkies(directory.string(), scene);
    const auto onLine = [&](const std::string& line) {
        spdlog::debug("{}", line);
        if (const auto fraction = fractionIn(line)) options.onProgress(*fraction);
    };
    const ChildResult child =
        runChild(blender.command(directory / "render_in_cycles.py", directory.string()), onLine,
                 options.shouldStop);
    CyclesResult result;
    result.stopped = child.stopped;
    if (result.stopped) return result;
    const nlohmann::json said = readResult(directory / "result.json");
    if (said.is_object() && said.contains("refused"))
        throw inputError("{}", said["refused"].get<std::string>());
    if (child.exitCode != 0 || !said.is_object()) throw blenderFailed(blender, child);
    result.version = said.value("version", "");
    result.mode = said.value("mode", "");
    result.interpolation = said.value("interpolation", "");
    result.seconds = said.value("seconds", 0.0);
    if (settings.draw && !fs::exists(directory / "image.exr")) throw blenderFailed(blender, child);
    if (settings.save) save(directory / "scene.blend", options.blend);
    if (settings.draw) writeImage(directory / "image.exr", scene, options, result);
    return result;
}

}  // namespace woodcock::tool
