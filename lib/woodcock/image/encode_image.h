// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock::image {

enum class PixelType { UInt8, UInt16, Half, Float };

struct ImageChannel {
    std::string name;
    PixelType type = PixelType::Float;
};

struct Rational {
    int numerator = 0;
    unsigned denominator = 1;
};
using Matrix44 = std::array<float, 16>;  ///< row by row; row vectors are multiplied from the left
using ImageAttribute =
    std::variant<int, float, std::string, std::vector<float>, Rational, Matrix44>;

/// The description of an image file, beside its pixels.
struct ImageHeader {
    std::string format;         ///< as OpenImageIO calls it: openexr, png, jpeg, tiff, webp
    Film::Window window;        ///< the position of the pixels in the whole image
    int width = 0, height = 0;  ///< of the whole image
    std::vector<ImageChannel> channels;
    std::vector<std::pair<std::string, ImageAttribute>> attributes;
};

/// The bytes of an image file. `pixels` holds header.window row by row, channels innermost; UInt8
/// rounds [0, 1] to 0 ... 255 and clamps, UInt16 to 0 ... 65535. Throws Error{Failure} with
/// OpenImageIO's reason.
std::vector<unsigned char> encodeImage(const ImageHeader& header, std::span<const float> pixels);

}  // namespace woodcock::image
