// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/image/encode_image.h"

namespace woodcock {

/// Writes the image `from`, of flat pixels in whatever format, as an EXR of floats with the same
/// channels and these attributes, none of its own. Whole or not at all. Throws Error{Input} where
/// `from` cannot be read, Error{Failure} where `to` cannot be written.
void annotateExr(const std::filesystem::path& from, const std::filesystem::path& to,
                 const std::vector<std::pair<std::string, ImageAttribute>>& attributes);

}  // namespace woodcock
