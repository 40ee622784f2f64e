// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/image_libraries.h"

#include <OpenColorIO/OpenColorIO.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <string_view>

namespace woodcock {

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

std::string imageLibraries() {
    const int version = OIIO::openimageio_version();  // 20407 is 2.4.7
    std::string text =
        fmt::format("OpenImageIO {}.{}.{}, OpenColorIO {}", version / 10000, version / 100 % 100,
                    version % 100, OCIO_NAMESPACE::GetVersion());
    for (const char* format : {"openexr", "png", "jpeg", "tiff"})
        if (const std::string library = libraryOf(format); !library.empty()) text += ", " + library;
    return text;
}

}  // namespace woodcock
