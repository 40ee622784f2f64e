// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "woodcock/base/spectrum.h"

namespace woodcock::surface {

/// Scene-linear colours over the unit square, repeated; row by row from the top left, v upwards.
class TextureImage {
public:
    /// Throws Error{Failure} where `rgb` does not hold width x height colours, or none.
    TextureImage(int width, int height, std::vector<float> rgb);
    Rgb at(double u, double v) const;  ///< bilinear between the centres of texels
    Rgb maximum() const;               ///< over all texels
    Rgb mean() const;
    int width() const { return width_; }
    int height() const { return height_; }

private:
    Rgb texel(int x, int y) const;

    int width_, height_;
    std::vector<float> rgb_;
};

/// A colour, or an image times one.
struct Texture {
    Rgb colour{1.0f};
    std::shared_ptr<const TextureImage> image;

    Texture() = default;
    Texture(Rgb c) : colour(c) {}
    Texture(Rgb c, std::shared_ptr<const TextureImage> i) : colour(c), image(std::move(i)) {}
    Rgb at(double u, double v) const { return image ? colour * image->at(u, v) : colour; }
    Rgb maximum() const { return image ? colour * image->maximum() : colour; }
};

}  // namespace woodcock::surface
