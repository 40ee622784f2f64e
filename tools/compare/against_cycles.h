// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/common/progress.h"
#include "tools/common/scene_input.h"
#include "woodcock/compare/comparison.h"

namespace woodcock::tool {

/// What `compare --cycles` renders by both programs.
struct BothOptions {
    SceneInput input;
    std::optional<int> spp, seeds;
    std::optional<std::string> mode, interpolation;
    std::optional<double> stepRate;
    std::string blender;
};

/// Renders the scene by Woodcock (A) and by Blender's Cycles (B), with several seeds each, into
/// `directory`, and returns the pictures' files; the log tells the times. Throws Error, and
/// ends the command where it was interrupted.
std::vector<compare::PictureSource> renderBoth(const BothOptions& options,
                                               const std::filesystem::path& directory,
                                               const std::string& commandLine, ProgressStyle style);

}  // namespace woodcock::tool
