// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "woodcock/camera/shutter.h"
#include "woodcock/scene/movements.h"

namespace woodcock::tool {

/// How finely Blender is told what moves: at the ends of as many pieces of the shutter as Cycles
/// cuts it into.
constexpr int cyclesMotionPieces = 16;

/// START, CENTER or END; empty of shutters that Blender does not have.
std::string cyclesShutterPosition(const camera::Shutter& shutter);

/// When what moves is told to Blender, in frames after the picture's.
std::vector<double> cyclesTimes(const camera::Shutter& shutter);

/// Where the first of the keys of a table ("volume[0]") was written.
std::string placeOfKeys(const scene::SceneDescription& scene, const std::string& table);

/// The places at these times of what is at `rest` at the frame, as JSON; null where it stands
/// still. Throws Error{Input} where it jumps, being that of a table of the scene.
nlohmann::json cyclesMotion(const scene::Movements::Movement& movement, const Affine3d& rest,
                            const scene::SceneDescription& scene, const std::string& table);

}  // namespace woodcock::tool
