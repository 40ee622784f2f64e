// SPDX-License-Identifier: Apache-2.0
#include "tools/common/scene_input.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/common/frames.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/image/image_format.h"
#include "woodcock/scene/animation.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/frame_files.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::tool {

namespace {

scene::SceneDescription parseWith(const SceneInput& input,
                                  const std::vector<std::string>& overrides) {
    if (isSceneFile(input.files.front())) return scene::parseScene(input.files.front(), overrides);
    const std::string name = "command line";
    scene::SceneDescription scene = scene::parseSceneText(
        scene::defaultSceneText(input.files, input.look), name, "", overrides);
    std::erase_if(scene.places, [&](const auto& place) { return place.second.starts_with(name); });
    return scene;
}

/// The up axis that the camera of a scene suggests.
scene::UpAxis upOfCamera(const scene::CameraDescription& camera) {
    Vec3d up = camera.given.up.value_or(Vec3d{0, 1, 0});
    if (camera.pose) up = scene::worldFromCamera(*camera.pose).column[1];
    return std::abs(up.z) > std::abs(up.y) ? scene::UpAxis::Z : scene::UpAxis::Y;
}

/// What --sun sets in a scene.
std::vector<std::string> sunOverrides(const scene::SceneDescription& scene,
                                      std::pair<double, double> place) {
    std::size_t index = 0;  // of the chosen lights, where there are none
    const scene::SunDescription* sun = nullptr;
    while (index < scene.lights.size() &&
           !(sun = std::get_if<scene::SunDescription>(&scene.lights[index].light)))
        ++index;
    if (!scene.lights.empty() && !sun)
        throw usageError(
            "--sun: the scene has no sun to be moved; give it a [[light]] of type = \"sun\"");
    std::vector<std::string> set{fmt::format("light[{}].elevation={}", index, place.first),
                                 fmt::format("light[{}].azimuth={}", index, place.second)};
    if (sun && !sun->place && upOfCamera(scene.camera) == scene::UpAxis::Z)
        set.push_back(fmt::format("light[{}].up=z", index));
    return set;
}

scene::SceneDescription parseAtAnySize(const SceneInput& input,
                                       std::vector<std::string> overrides) {
    scene::SceneDescription scene = parseWith(input, overrides);
    if (input.sun) {
        for (std::string& set : sunOverrides(scene, *input.sun))
            overrides.push_back(std::move(set));
        scene = parseWith(input, overrides);
    }
    if (!input.frame) return scene;
    scene = scene::atFrame(scene, *input.frame);
    // Between two frames, the files are those of the first.
    const auto whole = static_cast<int>(std::floor(*input.frame));
    return scene::readsFrames(scene) ? scene::FrameFiles().at(scene, whole) : scene;
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
    checkNoFrames(files, input.overlay, input.frames || input.frame);
}

CLI::Option* addOverlay(CLI::App& command, bool& overlay) {
    return command.add_flag("--overlay", overlay,
                            "Draw all volumes into one picture, even if their names differ only in "
                            "a number, as frames' names do");
}

// The size goes through the scene file, where cameras depend on it. What it replaces is checked
// all the same.
scene::SceneDescription parseInput(const SceneInput& input) {
    scene::SceneDescription scene = parseAtAnySize(input, input.overrides);
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

std::vector<std::filesystem::path> filesRead(const SceneInput& input,
                                             scene::SceneDescription scene) {
    std::vector<std::filesystem::path> files = input.files;
    for (const std::filesystem::path* file : scene::sceneFiles(scene)) files.push_back(*file);
    files.push_back(scene.ocio);
    return files;
}

std::vector<std::string> velocityNotes(const scene::SceneDescription& scene,
                                       const scene::LoadedScene& loaded) {
    std::set<std::filesystem::path> told;
    std::vector<std::string> notes;
    const bool open = scene.camera.shutter != camera::Shutter{};
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const std::filesystem::path& file = scene.volumes[i].file;
        const scene::LoadedVolume& volume = loaded.volumes[i];
        if (file.empty() || volume.velocity || !told.insert(file).second) continue;
        const std::string& grid = volume.velocities;
        if (open && scene.needsVelocities(scene.volumes[i]))
            notes.push_back(fmt::format(
                "{}: {}: it stands still while the shutter is open", file.string(),
                grid.empty()
                    ? "it has no velocities"
                    : fmt::format("its velocities ('{}') are 0, or not three of them", grid)));
        else if (!open && !grid.empty())
            notes.push_back(fmt::format(
                "{}: its velocities ('{}') are not used, as the shutter opens for no time; "
                "--shutter 0.5 blurs what moves",
                file.string(), grid));
    }
    return notes;
}

std::filesystem::path frameToChooseFrom(const scene::SceneDescription& description) {
    constexpr std::size_t fewest = 3;  // two files are as likely two versions
    if (description.volumes.size() != 1) return {};
    const std::filesystem::path& file = description.volumes[0].file;
    if (file.empty() || !scene::findPlace(description.places, "volume[0].file").empty()) return {};
    const FrameSeries series = seriesAround(file);
    if (series.numbers.size() < fewest) return {};
    std::filesystem::path largest;
    std::uintmax_t most = 0;
    for (const std::string& number : series.numbers) {
        std::error_code none;
        const std::uintmax_t size = std::filesystem::file_size(series.name(number), none);
        if (!none && size > most) largest = series.name(number), most = size;
    }
    return largest;
}

scene::LoadedScene loadAndComplete(scene::SceneDescription& description, scene::Look look) {
    scene::LoadedScene loaded = scene::loadScene(description);
    for (const std::string& note : loaded.notes) spdlog::warn("{}", note);
    const std::filesystem::path frame =
        look == scene::Look::Picture ? frameToChooseFrom(description) : std::filesystem::path();
    std::vector<std::string> choices;
    if (frame.empty() || frame == description.volumes[0].file) {
        choices = scene::completeScene(description, loaded, look);
    } else {
        scene::SceneDescription other = description;
        other.volumes[0].file = frame;
        choices = scene::completeScene(description, scene::loadScene(other), look);
    }
    if (!frame.empty())
        spdlog::info(
            "{} looks like a frame of a sequence: what follows is chosen from its largest file, "
            "{}, and is the same for every frame",
            description.volumes[0].file.string(), frame.string());
    for (const std::string& choice : choices) spdlog::info("{}", choice);
    scene::loadChosen(description, loaded);
    for (const std::string& note : velocityNotes(description, loaded)) spdlog::info("{}", note);
    return loaded;
}

}  // namespace woodcock::tool
