// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_display.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/encode_image.h"
#include "woodcock/image/image_format.h"

namespace woodcock::image {

namespace {

struct Encoding {
    const char* format;  // as OpenImageIO calls it
    PixelType type;
    bool holdsAlpha;
    std::vector<std::pair<std::string, ImageAttribute>> attributes;
};

Encoding encodingOf(ImageFormat format) {
    switch (format) {
        case ImageFormat::Jpeg:
            return {"jpeg", PixelType::UInt8, false, {{"CompressionQuality", 95}}};
        case ImageFormat::Tiff:
            return {"tiff", PixelType::UInt16, true, {{"Compression", std::string("zip")}}};
        case ImageFormat::WebP:
            // OpenImageIO divides the bytes by alpha, whatever is said about them, and it halves
            // the resolution of colour even in lossless compression.
            return {"webp", PixelType::UInt8, false, {{"Compression", std::string("webp:95")}}};
        default:
            return {"png", PixelType::UInt8, true, {{"CompressionQuality", 95}}};
    }
}

struct ScenePixels {
    std::vector<float> rgba;  ///< scene-linear, of the crop
    std::size_t raised = 0;   ///< pixels of more light than their alpha covers
};

/// Colours are not multiplied by alpha where alpha is kept.
ScenePixels scenePixels(const Film& film, bool straight, const DisplayFileSettings& settings,
                        const DenoisedPicture* denoised) {
    ScenePixels pixels;
    const Film::Window crop = film.crop();
    pixels.rgba.reserve(4 * static_cast<std::size_t>(crop.width()) *
                        static_cast<std::size_t>(crop.height()));
    const double gain = std::exp2(settings.exposure);
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const Rgb radiance = denoised ? denoised->radiance(x, y) : film.radiance(x, y);
            float alpha = film.alpha(x, y);
            const double light = std::min(1.0, gain * double{radiance.maximum()});
            if (straight && settings.glows && light > double{alpha})
                alpha = static_cast<float>(light), ++pixels.raised;
            const float unmultiply = straight && alpha > 0 ? 1 / alpha : 1.0f;
            const Rgb colour = radiance * unmultiply;
            pixels.rgba.insert(pixels.rgba.end(), {colour[0], colour[1], colour[2], alpha});
        }
    return pixels;
}

std::vector<float> withoutAlpha(const std::vector<float>& rgba) {
    std::vector<float> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    return rgb;
}

}  // namespace

double writeDisplay(const std::filesystem::path& file, const Film& film,
                    const DisplayTransform& transform, const DisplayFileSettings& settings,
                    const DenoisedPicture* denoised) {
    const Encoding encoding = encodingOf(imageFormat(file));
    const bool alpha = settings.withAlpha && encoding.holdsAlpha;
    ScenePixels pixels = scenePixels(film, alpha, settings, denoised);
    transform.apply(pixels.rgba);

    // These formats have no window in a larger image: the crop is the whole picture.
    const int width = film.crop().width(), height = film.crop().height();
    ImageHeader header{encoding.format, {0, 0, width, height}, width, height, {}, {}};
    for (const char* name : {"R", "G", "B"}) header.channels.push_back({name, encoding.type});
    if (alpha) header.channels.push_back({"A", encoding.type});
    header.attributes = {{"Software", fmt::format("woodcock {}", version())},
                         {"oiio:UnassociatedAlpha", 1}};
    header.attributes.insert(header.attributes.end(), encoding.attributes.begin(),
                             encoding.attributes.end());
    writeWholeFile(file, encodeImage(header, alpha ? pixels.rgba : withoutAlpha(pixels.rgba)));
    return static_cast<double>(pixels.raised) / (double(width) * height);
}

}  // namespace woodcock::image
