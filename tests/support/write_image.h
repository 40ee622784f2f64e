// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "woodcock/base/whole_file.h"
#include "woodcock/image/encode_image.h"

namespace woodcock::test {

/// An image file to be written: a float EXR unless it says otherwise.
struct ImageFile {
    int width = 16, height = 12;
    std::vector<std::string> channels{"R", "G", "B"};
    /// In image coordinates, `channel` into `channels`; bytes as 0..1.
    std::function<double(int x, int y, std::size_t channel)> value = [](int x, int y,
                                                                        std::size_t c) {
        return 0.1 + 0.01 * x + 0.02 * y + 0.1 * static_cast<double>(c);
    };
    image::PixelType type = image::PixelType::Float;
    std::string format = "openexr";
    image::Film::Window window{0, 0, 0, 0};  ///< empty: all
    std::vector<std::pair<std::string, image::ImageAttribute>> attributes{};
};

inline std::filesystem::path writeImage(const std::filesystem::path& file, const ImageFile& image) {
    image::ImageHeader header{image.format, image.window, image.width,
                              image.height, {},           image.attributes};
    if (header.window.width() == 0) header.window = {0, 0, image.width, image.height};
    for (const std::string& name : image.channels) header.channels.push_back({name, image.type});
    std::vector<float> pixels;
    for (int y = header.window.y0; y < header.window.y1; ++y)
        for (int x = header.window.x0; x < header.window.x1; ++x)
            for (std::size_t c = 0; c < image.channels.size(); ++c)
                pixels.push_back(static_cast<float>(image.value(x, y, c)));
    writeWholeFile(file, image::encodeImage(header, pixels));
    return file;
}

}  // namespace woodcock::test
