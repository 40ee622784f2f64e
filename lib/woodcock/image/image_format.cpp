// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/image_format.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "woodcock/base/error.h"

namespace woodcock {

ImageFormat imageFormat(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr") return ImageFormat::Exr;
    if (extension == ".png") return ImageFormat::Png;
    if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::Jpeg;
    if (extension == ".tif" || extension == ".tiff") return ImageFormat::Tiff;
    if (extension == ".webp") return ImageFormat::WebP;
    throw usageError("cannot write '{}': {}; known: .exr, .png, .jpg, .jpeg, .tif, .tiff, .webp",
                     file.string(),
                     extension.empty() ? "it has no extension to tell the format"
                                       : fmt::format("unknown image extension '{}'", extension));
}

}  // namespace woodcock
