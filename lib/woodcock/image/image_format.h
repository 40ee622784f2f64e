// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace woodcock {

enum class ImageFormat { Exr, Png, Jpeg, Tiff, WebP };

/// By extension, letter case aside: .exr, .png, .jpg, .jpeg, .tif, .tiff, .webp. Throws
/// Error{Usage} on any other.
ImageFormat imageFormat(const std::filesystem::path& file);

}  // namespace woodcock
