// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/render/scene.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// The scene that a render draws, from a complete description (see completeScene) and what was
/// loaded for it. Adds to `notes` what the user should know. Throws Error{Usage} where the
/// description is not complete.
render::Scene buildScene(const SceneDescription& description, LoadedScene loaded,
                         std::vector<std::string>* notes = nullptr);

/// What the session is told of a scene file's [render]: all of the image, by all cores.
render::RenderSettings renderSettings(const RenderDescription& render);

Affine3d worldFromCamera(const CameraPose& pose);

/// The rotation that takes an environment image's up, +y, and centre, -z, to where they are.
Affine3d worldFromLight(const EnvironmentDescription& environment);

}  // namespace woodcock::scene
