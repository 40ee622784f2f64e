// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_image.h"

#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/image/openimageio_input.h"

namespace woodcock::image {

namespace {

/// The indices of R, G and B among the channels; all the same for a grey image.
std::array<int, 3> colourChannels(const OIIO::ImageSpec& spec) {
    const std::array<int, 3> named{spec.channelindex("R"), spec.channelindex("G"),
                                   spec.channelindex("B")};
    if (named[0] >= 0 && named[1] >= 0 && named[2] >= 0) return named;
    if (spec.nchannels >= 3) return {0, 1, 2};
    return {0, 0, 0};
}

void refuseWhatIsNoLight(const Image& image, const std::filesystem::path& file) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        if (std::isfinite(image.rgb[i]) && image.rgb[i] >= 0) continue;
        if (count++ == 0) first = i;
    }
    if (count == 0) return;
    const std::size_t pixel = first / 3, width = static_cast<std::size_t>(image.width);
    throw inputError(
        "image '{}' holds {} negative, NaN or infinite value{}, the first one {} in "
        "{} at column {}, row {} (from 0, top left); light is finite and not negative",
        file.string(), count, count == 1 ? "" : "s", image.rgb[first],
        std::array{"red", "green", "blue"}[first % 3], pixel % width, pixel / width);
}

}  // namespace

Image readImage(const std::filesystem::path& file) {
    OpenImage input(file);
    const OIIO::ImageSpec& spec = input.spec();
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    const auto pixels = static_cast<std::size_t>(spec.image_pixels());
    std::vector<float> all(pixels * channels);
    input.read(all.data());

    Image image{spec.width, spec.height, std::vector<float>(pixels * 3)};
    const std::array<int, 3> from = colourChannels(spec);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            image.rgb[i * 3 + c] = all[i * channels + static_cast<std::size_t>(from[c])];
    refuseWhatIsNoLight(image, file);
    return image;
}

}  // namespace woodcock::image
