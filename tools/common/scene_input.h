// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/base/parse.h"
#include "woodcock/scene/load.h"

namespace woodcock::tool {

/// A scene file (.toml), or VDB files that a scene is made around.
struct SceneInput {
    std::vector<std::filesystem::path> files;
    std::vector<std::string> overrides;                 ///< of --set
    std::optional<ImageSize> size;                      ///< of --res
    std::optional<std::pair<double, double>> sun = {};  ///< of --sun: elevation and azimuth
    bool overlay = false;  ///< of --overlay: files that look like frames belong into one picture
};

/// The option that sets `overlay`.
CLI::Option* addOverlay(CLI::App& command, bool& overlay);

bool isSceneFile(const std::filesystem::path& file);

/// Throws Error{Usage} on an empty name, on a scene file beside other inputs, and on what expects
/// several frames to be drawn.
void checkInput(const SceneInput& input);

/// The scene, at the size that is asked for.
scene::SceneDescription parseInput(const SceneInput& input);

/// All files that are read for a scene: those that were given, and those that it names.
std::vector<std::filesystem::path> filesRead(const SceneInput& input,
                                             scene::SceneDescription scene);

/// Loads what the scene names and fills in what it leaves open; the log tells.
scene::LoadedScene loadAndComplete(scene::SceneDescription& description);

}  // namespace woodcock::tool
