// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/base/parse.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/load.h"

namespace woodcock::tool {

/// A scene file (.toml), or VDB files that a scene is made around.
struct SceneInput {
    std::vector<std::filesystem::path> files;
    std::vector<std::string> overrides;                 ///< of --set
    std::optional<ImageSize> size;                      ///< of --res
    std::optional<std::pair<double, double>> sun = {};  ///< of --sun: elevation and azimuth
    scene::Look look = scene::Look::Picture;            ///< of what is chosen
    std::optional<double> frame = {};                   ///< of --frame; absent: 0
    bool overlay = false;  ///< of --overlay: files that look like frames belong into one picture
    bool frames = false;   ///< names of volumes may hold a place for a frame's number
};

/// The option that sets `overlay`.
CLI::Option* addOverlay(CLI::App& command, bool& overlay);

bool isSceneFile(const std::filesystem::path& file);

/// Throws Error{Usage} on an empty name, on a scene file beside other inputs, and on what expects
/// several frames to be drawn.
void checkInput(const SceneInput& input);

/// The scene, at the size and the frame that are asked for.
scene::SceneDescription parseInput(const SceneInput& input);

/// All files that are read for a scene: those that were given, and those that it names.
std::vector<std::filesystem::path> filesRead(const SceneInput& input,
                                             scene::SceneDescription scene);

/// Tells of velocities that are not used; each volume's file once.
std::vector<std::string> velocityNotes(const scene::SceneDescription& scene,
                                       const scene::LoadedScene& loaded);

/// The frame from which all that is open is chosen for every frame of a sequence: the largest file,
/// the first of several. Empty where the scene is not made around one file that looks like a frame:
/// there are three files or more whose names differ from its in the last number only.
std::filesystem::path frameToChooseFrom(const scene::SceneDescription& description);

/// Loads what the scene names and fills in what it leaves open; the log tells. Picture: from
/// frameToChooseFrom(), where there is one.
scene::LoadedScene loadAndComplete(scene::SceneDescription& description,
                                   scene::Look look = scene::Look::Picture);

}  // namespace woodcock::tool
