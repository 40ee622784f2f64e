// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "woodcock/image/layers.h"
#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// The light groups that a scene names, each once: of its volumes, materials, what its surfaces
/// hold, and lights, in this order. Lights that are still to be chosen count.
std::vector<std::string> lightGroups(const SceneDescription& scene);

/// The number of a group among `groups`, from 1; 0 of an empty name.
std::uint8_t groupNumber(std::span<const std::string> groups, const std::string& name);

/// The group that the light of a material counts to; empty: none. Of a mix it is that of what
/// emits.
std::string groupOfMaterial(const SceneDescription& scene, const MaterialDescription& material);

/// The layers that the scene's output asks for, but for those that say nothing of a denoised
/// picture, where it is one. Throws Error{Usage} as image::layersFromNames().
image::LayerList outputLayers(const SceneDescription& scene);
/// What these, and the denoiser, need of a render.
image::LayerNeeds layerNeeds(const SceneDescription& scene);

/// Throws Error{Input} with the place where there are more groups than can be told apart, where a
/// mix has two, and where the output names a layer of a group that is not there.
void checkLightGroups(const SceneDescription& scene);

}  // namespace woodcock::scene
