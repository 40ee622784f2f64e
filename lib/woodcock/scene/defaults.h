// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock {

/// The scene file that stands for VDB files alone: a [[volume]] for each, with paths as given
/// (relative to the working directory). What it leaves open, completeScene() chooses.
std::string defaultSceneText(const std::vector<std::filesystem::path>& vdbFiles);

/// Chooses what the description leaves open: densities' scales, so that a typical ray through the
/// volume has an optical depth of about 10; a camera that frames all volumes; a warm sun from its
/// upper left and a blue sky. Returns a line for each choice, to be reported; writeScene() of the
/// completed description fixes them all.
std::vector<std::string> completeScene(SceneDescription& description, const LoadedScene& loaded);

}  // namespace woodcock
