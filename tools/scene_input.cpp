// SPDX-License-Identifier: Apache-2.0
#include "scene_input.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/image/image_format.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/parse.h"
#include "woodcock/scene/scene_files.h"

namespace woodcock::tool {

namespace {

SceneDescription parseAtAnySize(const SceneInput& input,
                                const std::vector<std::string>& overrides) {
    if (isSceneFile(input.files.front())) return parseScene(input.files.front(), overrides);
    const std::string name = "command line";
    SceneDescription scene = parseSceneText(defaultSceneText(input.files), name, "", overrides);
    std::erase_if(scene.places, [&](const auto& place) { return place.second.starts_with(name); });
    return scene;
}

}  // namespace

bool isSceneFile(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".toml";
}

void checkInput(const SceneInput& input) {
    const auto& files = input.files;
    if (files.size() > 1 && std::any_of(files.begin(), files.end(), isSceneFile))
        throw usageError("a scene file is rendered alone, but {} inputs are given", files.size());
    if (std::any_of(files.begin(), files.end(), [](const auto& file) { return file.empty(); }))
        throw usageError("an input is empty; name a scene (.toml) or volumes (.vdb, .nvdb)");
}

// The size goes through the scene file, where cameras depend on it. What it replaces is checked
// all the same.
SceneDescription parseInput(const SceneInput& input) {
    SceneDescription scene = parseAtAnySize(input, input.overrides);
    if (!input.size) return scene;
    const int width = input.size->width;
    const double shape = double(scene.render.height) / scene.render.width;
    const double height = input.size->height.value_or(std::max(1.0, std::round(width * shape)));
    if (height > largestImageSide)
        throw usageError("--res {} in the scene's shape is {} pixels high; the most are {}", width,
                         height, largestImageSide);
    std::vector<std::string> overrides = input.overrides;
    overrides.push_back(fmt::format("render.resolution=[{}, {}]", width, height));
    scene = parseAtAnySize(input, overrides);
    scene.places["render.resolution"] = "--res";
    return scene;
}

std::vector<std::filesystem::path> filesRead(const SceneInput& input, SceneDescription scene) {
    std::vector<std::filesystem::path> files = input.files;
    for (const std::filesystem::path* file : sceneFiles(scene)) files.push_back(*file);
    files.push_back(scene.ocio);
    return files;
}

LoadedScene loadAndComplete(SceneDescription& description) {
    LoadedScene loaded = loadScene(description);
    for (const std::string& note : loaded.notes) spdlog::warn("{}", note);
    for (const std::string& choice : completeScene(description, loaded)) spdlog::info("{}", choice);
    return loaded;
}

}  // namespace woodcock::tool
