// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/read_image.h"

#include <OpenImageIO/imageio.h>

#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"

namespace woodcock {

namespace {

using Input = std::unique_ptr<OIIO::ImageInput>;

Input open(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        throw inputError("cannot read image '{}': there is no such file", file.string());
    if (std::filesystem::is_directory(file, ignored))
        throw inputError("cannot read image '{}': it is a directory", file.string());
    OIIO::ImageSpec asItIs;  // else colours come multiplied by alpha, in the file's own space
    asItIs.attribute("oiio:UnassociatedAlpha", 1);
    Input input = OIIO::ImageInput::open(file.string(), &asItIs);
    if (!input) throw inputError("cannot read image '{}': {}", file.string(), OIIO::geterror());
    return input;
}

/// Where R, G and B are among the channels; all the same for a grey image.
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
    const Input input = open(file);
    const OIIO::ImageSpec& spec = input->spec();
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    const auto pixels = static_cast<std::size_t>(spec.image_pixels());
    if (pixels * channels == 0 || spec.deep || spec.depth > 1)
        throw inputError("cannot read image '{}': it has no flat pixels", file.string());
    const double bytes =
        static_cast<double>(pixels) * static_cast<double>(channels + 3) * sizeof(float);
    if (const auto limit = static_cast<double>(memoryLimit()); bytes > limit)
        throw inputError(
            "cannot read image '{}': {} x {} with {} channels need {} of memory, and "
            "there is {}",
            file.string(), spec.width, spec.height, channels, formatGiB(bytes), formatGiB(limit));
    std::vector<float> all(pixels * channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, all.data()))
        throw inputError("cannot read image '{}': {}", file.string(), input->geterror());

    Image image{spec.width, spec.height, std::vector<float>(pixels * 3)};
    const std::array<int, 3> from = colourChannels(spec);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            image.rgb[i * 3 + c] = all[i * channels + static_cast<std::size_t>(from[c])];
    refuseWhatIsNoLight(image, file);
    return image;
}

}  // namespace woodcock
