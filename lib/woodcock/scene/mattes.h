// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/image/cryptomatte.h"
#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// The layers of mattes that these words ask for (see image::matteKinds()), with the names of all
/// volumes and surfaces, or of what they are made of.
///
/// What the scene gives no name is called by its file without extension and frame number, or by its
/// shape; where that name is taken already, a number is added. `notes` says which. A volume is its
/// own material; surfaces without a material share "default".
///
/// Throws Error{Input} where the scene gives one name to two things of a layer, and where two names
/// have one id. Throws Error{Usage} on another word.
std::vector<image::MatteLayer> matteLayers(const SceneDescription& scene,
                                           const std::vector<std::string>& kinds,
                                           std::vector<std::string>* notes = nullptr);

}  // namespace woodcock::scene
