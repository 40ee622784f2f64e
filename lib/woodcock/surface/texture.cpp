// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/texture.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"

namespace woodcock::surface {

namespace {

/// The two of `size` texels in a row whose centres lie around a coordinate of the unit square.
struct Neighbours {
    int first = 0, second = 0;
    float weight = 0;  // of the second

    Neighbours(double coordinate, int size) {
        double place = coordinate - std::floor(coordinate);
        if (!std::isfinite(place)) place = 0;
        place = place * size - 0.5;
        const double below = std::floor(place);
        weight = static_cast<float>(place - below);
        // From -1, before the first centre, to size - 1; rounding may add one.
        first = (static_cast<int>(below) + size) % size;
        second = (first + 1) % size;
    }
};

}  // namespace

TextureImage::TextureImage(int width, int height, std::vector<float> rgb)
    : width_(width), height_(height), rgb_(std::move(rgb)) {
    if (width < 1 || height < 1 ||
        rgb_.size() / 3 != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) ||
        rgb_.size() % 3 != 0)
        throw failure("a texture of {} x {} texels cannot have {} numbers", width, height,
                      rgb_.size());
}

Rgb TextureImage::texel(int x, int y) const {
    const std::size_t i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(x)) *
                          3;
    return {rgb_[i], rgb_[i + 1], rgb_[i + 2]};
}

Rgb TextureImage::at(double u, double v) const {
    const Neighbours x(u, width_), y(1 - v, height_);
    const auto across = [&](int row) {
        return texel(x.first, row) * (1 - x.weight) + texel(x.second, row) * x.weight;
    };
    return across(y.first) * (1 - y.weight) + across(y.second) * y.weight;
}

Rgb TextureImage::maximum() const {
    Rgb most = texel(0, 0);
    for (std::size_t i = 0; i < rgb_.size(); ++i) {
        float& channel = most[static_cast<int>(i % 3)];
        channel = std::max(channel, rgb_[i]);
    }
    return most;
}

Rgb TextureImage::mean() const {
    double sum[3] = {};
    for (std::size_t i = 0; i < rgb_.size(); ++i) sum[i % 3] += double{rgb_[i]};
    const double count = static_cast<double>(rgb_.size() / 3);
    return Rgb::map([&](int c) { return static_cast<float>(sum[c] / count); });
}

}  // namespace woodcock::surface
