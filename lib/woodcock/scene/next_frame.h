// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "woodcock/render/next_frame.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// Whether the output of a scene has the layer of motion.
bool asksForMotion(const SceneDescription& scene);

/// Where what a scene shows goes until the next frame: by its keys, and by the velocities of its
/// volumes, which go on straight. Throws Error{Input} on what cannot move within a shutter.
std::shared_ptr<const render::NextFrame> buildNextFrame(const SceneDescription& description,
                                                        const LoadedScene& loaded);

}  // namespace woodcock::scene
