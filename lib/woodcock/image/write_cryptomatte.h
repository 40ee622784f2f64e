// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "woodcock/image/matte_film.h"
#include "woodcock/image/write_exr.h"

namespace woodcock::image {

/// Writes mattes alone, as an EXR with the crop as data window. `film` has the same samples. Whole
/// or not at all; throws Error{Failure}.
void writeCryptomatte(const std::filesystem::path& file, const MatteFilm& mattes, const Film& film,
                      const RenderMetadata& metadata);

}  // namespace woodcock::image
