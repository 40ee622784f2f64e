// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/image_format.h"

#include <OpenColorIO/OpenColorIO.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "woodcock/base/error.h"

namespace woodcock::image {

namespace {

/// The library of a format in OpenImageIO's list:
/// "bmp;jpeg:jpeg-turbo 2.1.5;openexr:OpenEXR 3.1.5".
std::string libraryOf(std::string_view format) {
    const std::string list = OIIO::get_string_attribute("library_list");
    std::string_view rest = list;
    while (!rest.empty()) {
        const std::string_view entry = rest.substr(0, rest.find(';'));
        rest.remove_prefix(std::min(entry.size() + 1, rest.size()));
        if (entry.starts_with(format) && entry.substr(format.size()).starts_with(':'))
            return std::string(entry.substr(format.size() + 1));
    }
    return "";
}

}  // namespace

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

std::string imageLibraries() {
    const int version = OIIO::openimageio_version();  // 20407 is 2.4.7
    std::string text =
        fmt::format("OpenImageIO {}.{}.{}, OpenColorIO {}", version / 10000, version / 100 % 100,
                    version % 100, OCIO_NAMESPACE::GetVersion());
    for (const char* format : {"openexr", "png", "jpeg", "tiff"})
        if (const std::string library = libraryOf(format); !library.empty()) text += ", " + library;
    return text;
}

}  // namespace woodcock::image
