// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace woodcock::image {

enum class ImageFormat { Exr, Png, Jpeg, Tiff, WebP };

/// By extension, letter case aside: .exr, .png, .jpg, .jpeg, .tif, .tiff, .webp. Throws
/// Error{Usage} on any other.
ImageFormat imageFormat(const std::filesystem::path& file);

/// The libraries that read and write images, with the versions that are loaded: "OpenImageIO
/// 2.4.7, OpenColorIO 2.1.2, OpenEXR 3.1.5".
std::string imageLibraries();

}  // namespace woodcock::image
