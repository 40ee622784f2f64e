// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/scene/description.h"

namespace woodcock::scene {

// Qualities are names for sets of choices: values of keys of [render].

/// From the fastest to the most accurate. Those from Final on are unbiased.
enum class Quality { Draft, Preview, Final, Reference };
inline const std::array<std::string, 4> qualityNames{"draft", "preview", "final", "reference"};

/// The key of [render] that names one.
inline constexpr std::string_view qualityKey = "quality";
/// The same as --set names it.
std::string qualityPath();

/// A key of [render] and its value, as TOML.
struct RenderChoice {
    std::string key, value;
    bool operator==(const RenderChoice&) const = default;
};
const std::vector<RenderChoice>& qualityChoices(Quality quality);

/// The keys of [render] that trade accuracy for time.
std::vector<std::string> choiceKeys();

/// The others that concern how a picture is found rather than what it shows.
std::vector<std::string> methodKeys();

/// Takes out what a scene says of choices (its volumes' storage too): --quality replaces it.
void eraseChoices(toml::table& scene);

/// Whether voxels are rounded where a float would not be.
bool isReducedPrecision(grid::Storage storage);

/// Gives [render] the choices of the quality that it names, but for those that are written beside
/// it and what contradicts them. Throws Error{Input} on unknown names.
void expandQuality(toml::table& scene);

/// The keys of a scene's choices that change its expected picture, named as for --set:
/// "render.clamp", "volume[0].storage".
std::vector<std::string> biasedChoices(const SceneDescription& scene);

}  // namespace woodcock::scene
