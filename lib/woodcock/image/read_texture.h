// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "woodcock/image/display.h"
#include "woodcock/image/read_image.h"

namespace woodcock::image {

/// Reads an image as readImage() does, and converts it from the named colour space of the config to
/// scene-linear colours. "linear", "raw" and "data" leave the numbers as they are. Empty: integers
/// are ordinary pictures (ColorConfig::pictureSpace), floats scene-linear. Values outside the gamut
/// of scene_linear, which would be negative, become 0. Throws Error{Input} on names that the config
/// does not have, and lists those that it has.
Image readTexture(const std::filesystem::path& file, const std::string& colourSpace,
                  const ColorConfig& config);

}  // namespace woodcock::image
