// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// What choices are for: a picture to show; or one as plain as can be, for comparisons.
enum class Look { Picture, Plain };

/// The scene file that stands for VDB files alone: a [[volume]] for each, with paths as given
/// (relative to the working directory). What it leaves open, completeScene() chooses. A file that
/// holds grids `sigma_a` or `sigma_s`, and no density, says all of its coefficients itself: they
/// are taken per world unit, as they are.
std::string defaultSceneText(const std::vector<std::filesystem::path>& vdbFiles,
                             Look look = Look::Picture);

/// Chooses what the description leaves open: density grids, by their usual names; their scales, so
/// that a typical ray through the volume has a certain optical depth (typicalDepth()); how fire
/// glows (chooseGlow()); a grid of colours as the albedo; a camera that frames all volumes and
/// surfaces; lights (chooseLights()). `loaded` may come from another file than the description
/// names, such as another frame of its sequence: what is chosen depends on `loaded` alone. Returns
/// a note for each volume, the camera and the lights where there was a choice: a line that tells,
/// and the TOML that fixes it. A volume that no scene file holds (findPlace of its file is empty)
/// is noted in full, so that the notes of such a scene are a scene file. writeScene() of the
/// completed description fixes all. Throws Error{Input} on an eye that cannot look at the volumes.
/// What it chose may have to be loaded: see loadChosen().
std::vector<std::string> completeScene(SceneDescription& description, const LoadedScene& loaded,
                                       Look look = Look::Picture);

/// The optical depth of a typical ray through a volume whose scale is chosen.
double typicalDepth(Look look);

}  // namespace woodcock::scene
