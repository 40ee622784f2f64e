// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/write_display.h"

#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/encode_image.h"
#include "woodcock/image/image_format.h"

namespace woodcock {

namespace {

/// Scene-linear R, G, B, A of the crop; R, G, B divided by alpha where `straight`.
std::vector<float> scenePixels(const Film& film, bool straight) {
    std::vector<float> pixels;
    const Film::Window crop = film.crop();
    pixels.reserve(4 * static_cast<std::size_t>(crop.width()) *
                   static_cast<std::size_t>(crop.height()));
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const float alpha = film.alpha(x, y);
            const float unmultiply = straight && alpha > 0 ? 1 / alpha : 1.0f;
            const Rgb colour = film.radiance(x, y) * unmultiply;
            pixels.insert(pixels.end(), {colour[0], colour[1], colour[2], alpha});
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

void writeDisplay(const std::filesystem::path& file, const Film& film,
                  const DisplayTransform& transform, bool withAlpha) {
    const bool jpeg = imageFormat(file) == ImageFormat::Jpeg;
    const bool alpha = withAlpha && !jpeg;
    std::vector<float> pixels = scenePixels(film, alpha);
    transform.apply(pixels);

    // Pictures have no window in a larger image: the crop is all there is.
    const int width = film.crop().width(), height = film.crop().height();
    ImageHeader header{jpeg ? "jpeg" : "png", {0, 0, width, height}, width, height, {}, {}};
    for (const char* name : {"R", "G", "B"}) header.channels.push_back({name, PixelType::UInt8});
    if (alpha) header.channels.push_back({"A", PixelType::UInt8});
    header.attributes = {{"Software", fmt::format("woodcock {}", version())},
                         {"oiio:UnassociatedAlpha", 1},
                         {"CompressionQuality", 95}};
    writeWholeFile(file, encodeImage(header, alpha ? pixels : withoutAlpha(pixels)));
}

}  // namespace woodcock
