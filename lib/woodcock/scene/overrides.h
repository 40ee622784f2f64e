// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <span>
#include <string>
#include <vector>
#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// Sets one value of a parsed scene file: "volume[0].scale=2", "render.spp=16". The value is TOML;
/// what is not (bare words, paths) is taken as a string. Missing tables of the path are made,
/// missing list elements are not. Values keep the override as their place (see placeOf).
/// Throws Error{Usage} when `text` is no KEY=VALUE, Error{Input} when the path does not lead
/// anywhere.
void applyOverride(toml::table& scene, const std::string& text);

/// What an override sets, without spaces: "volume[0].scale" of "volume[0].scale = 2".
std::string overriddenKey(const std::string& text);

/// Whether an override ("light[0].azimuth=200") is one of a light in a list of lights.
bool changesALight(const std::string& assignment);

/// `lights` with overrides applied as though they stood in a scene file. Throws Error{Input} where
/// such a file would be wrong.
std::vector<LightDescription> changedLights(const std::vector<LightDescription>& lights,
                                            std::span<const std::string> overrides);

/// The kinds of lights that completeScene() chooses, with the scene's changes: what is known of
/// them before the camera is. Those of the scene, where it has any.
std::vector<LightDescription> foreseenLights(const SceneDescription& scene);

/// Suns with a direction beside elevation and azimuth, of which one side was overridden, keep that.
void keepOverriddenSuns(toml::table& scene);

}  // namespace woodcock::scene
