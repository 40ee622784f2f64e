// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/common/progress.h"
#include "woodcock/bake/baker.h"
#include "woodcock/bake/recipe.h"
#include "woodcock/image/film.h"

namespace woodcock::tool {

struct PreviewSettings {
    int width = 360, height = 240;
    double seconds = 1.2;  ///< for the render; loading comes before it
    int threads = 0;       ///< 0: all
};

/// Throws what renderPreview() would throw for the picture's name and the recipe's own scene, at
/// once.
void checkPreview(const std::filesystem::path& picture, const bake::Recipe& recipe);

/// The scene that shows a baked file: the recipe's own, or one that follows from the file's grids.
/// `Cd` colours the smoke, `temperature` or `flame` is fire, `sigma_a` and `sigma_s` are taken as
/// they are.
std::string previewScene(const bake::Recipe& recipe, const bake::Bake& bake,
                         const std::filesystem::path& volume);

/// Nothing where it was interrupted before there was anything to see.
std::optional<image::Film> renderPreview(const bake::Recipe& recipe, const bake::Bake& bake,
                                         const std::filesystem::path& volume,
                                         const PreviewSettings& settings, ProgressStyle style);

/// Renders a baked file to a small picture. Returns false when it was interrupted (what was
/// rendered so far is written).
bool writePreview(const bake::Recipe& recipe, const bake::Bake& bake,
                  const std::filesystem::path& volume, const std::filesystem::path& picture,
                  const PreviewSettings& settings, ProgressStyle style);

}  // namespace woodcock::tool
