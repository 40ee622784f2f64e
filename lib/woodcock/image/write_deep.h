// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "woodcock/image/deep_film.h"
#include "woodcock/image/write_exr.h"

namespace woodcock::image {

/// Writes deep pixels as an EXR: R, G, B, A, Z and ZBack in float, with the crop as data window.
/// Whole or not at all; throws Error{Failure}. `film` has the same samples.
void writeDeep(const std::filesystem::path& file, const DeepFilm& deep, const Film& film,
               const RenderMetadata& metadata, const std::optional<Chromaticities>& chromaticities);

}  // namespace woodcock::image
