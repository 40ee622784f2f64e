// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "woodcock/scene/defaults.h"
#include "woodcock/scene/light_descriptions.h"

namespace woodcock::scene {

/// The lights that completeScene() chooses for a camera, where a scene has none. The first is a
/// warm sun to the camera's left (and, for a picture, 5 degrees on its side), 40 degrees high, as
/// light from the side shows form. The others are environments. For a picture, the second is a dark
/// backdrop that the camera sees, brightest at the horizon. The third fills the shadows and is not
/// seen, so that pale smoke stands out. Beside fire (`glows`), sun and fill are dim. The plain look
/// has one even blue sky instead.
std::vector<LightDescription> chosenLights(const Affine3d& worldFromCamera, UpAxis up, Look look,
                                           bool glows);

}  // namespace woodcock::scene
