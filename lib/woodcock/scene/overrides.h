// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <string>

namespace woodcock::scene {

/// Sets one value of a parsed scene file: "volume[0].scale=2", "render.spp=16". The value is TOML;
/// what is not (bare words, paths) is taken as a string. Missing tables of the path are made,
/// missing list elements are not. Values keep the override as their place (see placeOf).
/// Throws Error{Usage} when `text` is no KEY=VALUE, Error{Input} when the path does not lead
/// anywhere.
void applyOverride(toml::table& scene, const std::string& text);

/// What an override sets, without spaces: "volume[0].scale" of "volume[0].scale = 2".
std::string overriddenKey(const std::string& text);

}  // namespace woodcock::scene
