// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "woodcock/bake/node.h"
#include "woodcock/bake/parameters.h"

namespace woodcock::bake {

/// A grid that a recipe makes.
struct RecipeOutput {
    std::string name;
    int entry = 0;  ///< of the graph
    int channels = 1;
    double tolerance =
        0;  ///< values this close to zero are left out; values this close to each other are merged
    std::optional<int> mask;  ///< computed only where this other output is not empty
    std::string place;        ///< in the recipe's file
};

/// The placeholder of the baked file in a recipe's preview scene.
inline constexpr const char* previewVolume = "${VOLUME}";

/// A procedural medium: functions of space, and the grids to make of them.
struct Recipe {
    std::string name, about;
    ParameterSet parameters;
    Graph graph;
    Box3d bounds;  ///< world space; nothing is made outside
    std::vector<RecipeOutput> outputs;
    std::string boundsPlace;
    std::vector<std::filesystem::path> files;  ///< that its nodes read
    /// A scene that shows the baked file, which is "${VOLUME}" in it; empty: there is none.
    std::string preview;
    std::string previewPlace;
};

/// A recipe's text, and its source.
struct RecipeText {
    std::string text;
    std::string name;                 ///< for messages: the file
    std::filesystem::path directory;  ///< that relative paths in it start from
    std::optional<int> frame = {};    ///< filled into the names of its files, see withFrame()
};

/// "size=3": a parameter's new value, and the option that gave it, for messages.
struct ParameterSetting {
    std::string name;
    double value = 0;
    std::string origin;
};

/// The recipe that a file holds. Errors: Input.
RecipeText readRecipe(const std::filesystem::path& file);

/// Only its parameters, with these settings. Errors: as of makeRecipe().
ParameterSet recipeParameters(const RecipeText& text, const std::vector<ParameterSetting>& set);
std::string recipeAbout(const RecipeText& text);

/// Reads and checks a recipe, and loads the files that it names. Errors: Input, with file, line,
/// column, what was found and what was expected; Usage, of settings.
Recipe makeRecipe(const RecipeText& text, const std::vector<ParameterSetting>& set);

/// Recipes that come with the program, by name.
const std::map<std::string, std::string_view>& presets();

}  // namespace woodcock::bake
