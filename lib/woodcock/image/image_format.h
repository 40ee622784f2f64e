// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace woodcock {

enum class ImageFormat { Exr, Png, Jpeg };

/// By extension, letter case aside: .exr, .png, .jpg, .jpeg. Throws Error{Usage} on any other.
ImageFormat imageFormat(const std::filesystem::path& file);

}  // namespace woodcock
