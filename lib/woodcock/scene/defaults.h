// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// The scene file that stands for VDB files alone: a [[volume]] for each, with paths as given
/// (relative to the working directory). What it leaves open, completeScene() chooses.
std::string defaultSceneText(const std::vector<std::filesystem::path>& vdbFiles);

/// Chooses what the description leaves open: density grids, by their usual names; their scales, so
/// that a typical ray through the volume has an optical depth of about 10; a camera that frames all
/// volumes and surfaces; a warm sun from its upper left and a blue sky, unless surfaces emit light.
/// Returns a note for each volume, the camera and the lights where there was a choice: a line that
/// tells, and the TOML that fixes it. A volume that no scene file holds (findPlace of its file is
/// empty) is noted in full, so that the notes of such a scene are a scene file. writeScene() of the
/// completed description fixes all. Throws Error{Input} on an eye that cannot look at the volumes.
std::vector<std::string> completeScene(SceneDescription& description, const LoadedScene& loaded);

}  // namespace woodcock::scene
