// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_texture.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock::image {

namespace {

bool holdsFloats(const std::filesystem::path& file) {
    return OpenImage(file).spec().format.is_floating_point();
}

bool isPlain(const std::string& space) {
    return space == "linear" || space == "raw" || space == "data";
}

void convert(Image& image, const std::filesystem::path& file, const std::string& colourSpace,
             const ColorConfig& config) {
    const std::string space = colourSpace.empty() ? config.pictureSpace() : colourSpace;
    if (space.empty())
        throw inputError(
            "texture '{}' holds integers, and the OpenColorIO config has no colour space of a "
            "usual name, such as 'sRGB - Texture', for them; name the texture's colour space",
            file.string());
    try {
        config.toSceneLinear(image.rgb, space);
    } catch (const Error& e) {
        throw Error(e.kind(), fmt::format("texture '{}': {}", file.string(), e.what()));
    }
    for (float& v : image.rgb) {
        if (!std::isfinite(v))
            throw inputError(
                "texture '{}' holds values that colour space '{}' turns into {}; is it in another "
                "space?",
                file.string(), space, v);
        v = std::max(v, 0.0f);
    }
}

}  // namespace

Image readTexture(const std::filesystem::path& file, const std::string& colourSpace,
                  const ColorConfig& config) {
    Image image = readImage(file);
    const bool asItIs = colourSpace.empty() ? holdsFloats(file) : isPlain(colourSpace);
    if (!asItIs) convert(image, file, colourSpace, config);
    return image;
}

}  // namespace woodcock::image
