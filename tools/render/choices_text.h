// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/scene/description.h"

namespace woodcock::tool {

/// What a scene leaves open, before it is completed.
struct Openings {
    std::vector<bool> density, scale, glow, colour;  ///< of each volume
    bool camera = false, lights = false, exposure = false;
};
Openings openingsOf(const scene::SceneDescription& scene);

/// What was chosen, in one sentence: "chosen were the density scale 51 of smoke.vdb, a camera that
/// frames it, and ...".
std::string describeChoices(const Openings& open, const scene::SceneDescription& complete);

}  // namespace woodcock::tool
