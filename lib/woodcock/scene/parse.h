// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// Reads and checks a scene file; nothing that it names is opened. Relative paths in it are
/// relative to its directory. Each of `overrides` ("volume[0].scale=2", "render.spp=16") replaces
/// one value before the check; a relative path in an override is relative to the working directory.
/// Throws Error{Input} with file, line, column, the value and what was expected, for the first
/// mistake; Error{Usage} for an override that is no KEY=VALUE.
SceneDescription parseScene(const std::filesystem::path& file,
                            const std::vector<std::string>& overrides = {});

/// The same of a text in memory; `name` stands for the file in messages.
SceneDescription parseSceneText(std::string_view text, const std::string& name,
                                const std::filesystem::path& baseDirectory,
                                const std::vector<std::string>& overrides = {});

}  // namespace woodcock::scene
