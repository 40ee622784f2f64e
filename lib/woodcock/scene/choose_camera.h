// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/scene/description.h"

namespace woodcock::scene {

// What completeScene() does for the camera. `points` are those of sceneOutline().

Vec3d upVector(UpAxis up);

/// Places a camera that the scene leaves open, so that all points are seen; where it is to be
/// turned (orbit), from every side. Returns why it stands so; nothing where there was no choice.
/// Throws Error{Input} on an eye that cannot look at the volumes.
std::optional<std::string> chooseCamera(SceneDescription& scene, std::vector<Vec3d> points,
                                        UpAxis up);

/// Turns a placed camera by its `orbit`, which is then done: around what it looks at; one that a
/// matrix places, around the points' middle.
void turnCamera(CameraDescription& camera, const std::vector<Vec3d>& points);

}  // namespace woodcock::scene
