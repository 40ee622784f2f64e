// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/environment_map.h"

namespace woodcock::light {

namespace {

/// Index i of the step cdf[i] <= u < cdf[i+1] of positive height, and where inside it u lies.
std::pair<std::size_t, double> invert(const double* cdf, std::size_t n, double u) {
    const double target = u * cdf[n];
    const double* step = std::upper_bound(cdf, cdf + n + 1, target) - 1;
    auto i = std::min(static_cast<std::size_t>(step - cdf), n - 1);
    while (i > 0 && cdf[i + 1] == cdf[i]) --i;
    const double height = cdf[i + 1] - cdf[i];
    return {i, height > 0 ? std::clamp((target - cdf[i]) / height, 0.0, 1.0) : 0.5};
}

}  // namespace

EnvironmentMap::EnvironmentMap(int width, int height, std::vector<float> pixels)
    : width_(width), height_(height), pixels_(std::move(pixels)) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    rowCdf_.assign(h + 1, 0), columnCdf_.assign(h * (w + 1), 0);
    double solidAngle = 0;
    std::array<double, 3> total{};
    for (int y = 0; y < height; ++y) {
        const double top = std::cos(pi * y / height), bottom = std::cos(pi * (y + 1) / height);
        const double area = top - bottom;  // x 2 pi / width
        double* row = &columnCdf_[static_cast<std::size_t>(y) * (w + 1)];
        for (int x = 0; x < width; ++x) {
            // The pixel's brightness as bilinear interpolation spreads it: zero only where the
            // radiance is.
            double brightness = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i)
                    brightness += double{pixel(x + i, y + j).mean()} *
                                  ((2 - std::abs(i)) * (2 - std::abs(j)));
            row[x + 1] = row[x] + brightness * area;
            const Rgb p = pixel(x, y);
            for (int c = 0; c < 3; ++c) total[static_cast<std::size_t>(c)] += p[c] * area;
            solidAngle += area;
        }
        rowCdf_[static_cast<std::size_t>(y) + 1] = rowCdf_[static_cast<std::size_t>(y)] + row[w];
    }
    for (int c = 0; c < 3; ++c)
        mean_[c] = static_cast<float>(total[static_cast<std::size_t>(c)] / solidAngle);
}

Rgb EnvironmentMap::pixel(int x, int y) const {
    x = (x % width_ + width_) % width_, y = std::clamp(y, 0, height_ - 1);
    const std::size_t i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                               static_cast<std::size_t>(x));
    return {pixels_[i], pixels_[i + 1], pixels_[i + 2]};
}

Rgb EnvironmentMap::radiance(Vec3d d) const {
    const double u = (0.5 + std::atan2(d.x, -d.z) / (2 * pi)) * width_ - 0.5;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * height_ - 0.5;
    const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
    const auto fx = static_cast<float>(u - x), fy = static_cast<float>(v - y);
    return (pixel(x, y) * (1 - fx) + pixel(x + 1, y) * fx) * (1 - fy) +
           (pixel(x, y + 1) * (1 - fx) + pixel(x + 1, y + 1) * fx) * fy;
}

EnvironmentMap::Sample EnvironmentMap::sample(double u0, double u1) const {
    const auto w = static_cast<std::size_t>(width_), h = static_cast<std::size_t>(height_);
    if (!(rowCdf_[h] > 0)) return {{0, 1, 0}, 0};
    const auto [y, fy] = invert(rowCdf_.data(), h, u1);
    const auto [x, fx] = invert(&columnCdf_[y * (w + 1)], w, u0);
    // Uniform in solid angle inside the pixel: linear in the cosine of the polar angle.
    const double top = std::cos(pi * static_cast<double>(y) / height_);
    const double bottom = std::cos(pi * static_cast<double>(y + 1) / height_);
    const double cosine = top + (bottom - top) * fy;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double phi = 2 * pi * ((static_cast<double>(x) + fx) / width_ - 0.5);
    const double share =
        (columnCdf_[y * (w + 1) + x + 1] - columnCdf_[y * (w + 1) + x]) / rowCdf_[h];
    return {{sine * std::sin(phi), cosine, -sine * std::cos(phi)},
            share / (2 * pi / width_ * (top - bottom))};
}

double EnvironmentMap::pdf(Vec3d d) const {
    const auto w = static_cast<std::size_t>(width_), h = static_cast<std::size_t>(height_);
    if (!(rowCdf_[h] > 0)) return 0;
    const double u = (0.5 + std::atan2(d.x, -d.z) / (2 * pi)) * width_;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * height_;
    const auto x = std::min(static_cast<std::size_t>(std::max(0.0, u)), w - 1);
    const auto y = std::min(static_cast<std::size_t>(std::max(0.0, v)), h - 1);
    const double top = std::cos(pi * static_cast<double>(y) / height_);
    const double bottom = std::cos(pi * static_cast<double>(y + 1) / height_);
    const double share =
        (columnCdf_[y * (w + 1) + x + 1] - columnCdf_[y * (w + 1) + x]) / rowCdf_[h];
    return share / (2 * pi / width_ * (top - bottom));
}

}  // namespace woodcock::light
