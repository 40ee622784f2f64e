// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "woodcock/denoise/denoiser.h"
#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// The denoiser that a scene's pictures go through; absent: none. From then on the scene says
/// Always or Never, never IfInstalled. Throws Error{Usage} with the place where the scene demands
/// one and there is none that works. `notes`: tells what became of IfInstalled, but nothing where
/// none is installed.
std::optional<denoise::Denoiser> settleDenoising(SceneDescription& scene,
                                                 std::vector<std::string>* notes = nullptr);

}  // namespace woodcock::scene
