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
    : EnvironmentMap(width, height, {0, 0, width, height}, std::move(pixels)) {}

EnvironmentMap::EnvironmentMap(int width, int height, const Window& window,
                               std::vector<float> pixels)
    : width_(width), height_(height), window_(window), pixels_(std::move(pixels)) {
    tabulate();
}

/// Makes the tables for sampling, and the mean.
void EnvironmentMap::tabulate() {
    sampled_ = window_;
    if (window_.width + 2 <= width_) --sampled_.x, sampled_.width += 2;
    const int top = std::max(0, window_.y - 1),
              bottom = std::min(height_, window_.y + window_.height + 1);
    sampled_.y = top, sampled_.height = bottom - top;
    const auto w = static_cast<std::size_t>(sampled_.width),
               h = static_cast<std::size_t>(sampled_.height);
    rowCdf_.assign(h + 1, 0), columnCdf_.assign(h * (w + 1), 0);
    std::array<double, 3> total{};
    // A pixel's brightness as bilinear interpolation spreads it: zero only where the radiance is.
    // Here along a row.
    std::vector<double> means(w + 2);
    const auto spread = [&](int y) {
        const bool counts = y >= sampled_.y && y < sampled_.y + sampled_.height;
        const double area = std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_);
        for (std::size_t i = 0; i < means.size(); ++i) {
            const Rgb p = pixel(sampled_.x - 1 + static_cast<int>(i), y);
            means[i] = double{p.mean()};
            if (!counts || i == 0 || i > w) continue;
            for (int c = 0; c < 3; ++c) total[static_cast<std::size_t>(c)] += p[c] * area;
        }
        std::vector<double> row(w);
        for (std::size_t i = 0; i < w; ++i) row[i] = means[i] + 2 * means[i + 1] + means[i + 2];
        return row;
    };
    std::vector<double> above = spread(sampled_.y - 1), here = spread(sampled_.y);
    for (std::size_t k = 0; k < h; ++k) {
        const int y = sampled_.y + static_cast<int>(k);
        std::vector<double> below = spread(y + 1);
        const double area = std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_);
        double* row = &columnCdf_[k * (w + 1)];
        for (std::size_t i = 0; i < w; ++i)
            row[i + 1] = row[i] + (above[i] + 2 * here[i] + below[i]) * area;
        rowCdf_[k + 1] = rowCdf_[k] + row[w];
        above = std::move(here), here = std::move(below);
    }
    for (int c = 0; c < 3; ++c)
        mean_[c] = static_cast<float>(total[static_cast<std::size_t>(c)] / (2 * width_));
}

/// A pixel of the window, three floats; null outside of it.
float* EnvironmentMap::find(int x, int y) {
    x = ((x - window_.x) % width_ + width_) % width_;
    y = std::clamp(y, 0, height_ - 1) - window_.y;
    if (x >= window_.width || y < 0 || y >= window_.height) return nullptr;
    return &pixels_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(window_.width) +
                         static_cast<std::size_t>(x))];
}

Rgb EnvironmentMap::pixel(int x, int y) const {
    const float* p = const_cast<EnvironmentMap*>(this)->find(x, y);
    return p ? Rgb{p[0], p[1], p[2]} : Rgb();
}

Rgb EnvironmentMap::radiance(Vec3d d) const {
    const double u = (0.5 + std::atan2(d.x, -d.z) / (2 * pi)) * width_ - 0.5;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * height_ - 0.5;
    const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
    const auto fx = static_cast<float>(u - x), fy = static_cast<float>(v - y);
    return (pixel(x, y) * (1 - fx) + pixel(x + 1, y) * fx) * (1 - fy) +
           (pixel(x, y + 1) * (1 - fx) + pixel(x + 1, y + 1) * fx) * fy;
}

/// Of a place in the image, in pixels.
Vec3d EnvironmentMap::direction(double x, double y) const {
    const double polar = pi * y / height_, phi = 2 * pi * (x / width_ - 0.5);
    const double sine = std::sin(polar);
    return {sine * std::sin(phi), std::cos(polar), -sine * std::cos(phi)};
}

EnvironmentMap::Sample EnvironmentMap::sample(double u0, double u1) const {
    const auto w = static_cast<std::size_t>(sampled_.width),
               h = static_cast<std::size_t>(sampled_.height);
    if (!(rowCdf_[h] > 0)) return {{0, 1, 0}, 0};
    const auto [row, fy] = invert(rowCdf_.data(), h, u1);
    const auto [column, fx] = invert(&columnCdf_[row * (w + 1)], w, u0);
    const double x = static_cast<double>(column) + sampled_.x,
                 y = static_cast<double>(row) + sampled_.y;
    // Uniform in solid angle inside the pixel: linear in the cosine of the polar angle.
    const double top = std::cos(pi * y / height_), bottom = std::cos(pi * (y + 1) / height_);
    const double cosine = top + (bottom - top) * fy;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double phi = 2 * pi * ((x + fx) / width_ - 0.5);
    const double share =
        (columnCdf_[row * (w + 1) + column + 1] - columnCdf_[row * (w + 1) + column]) / rowCdf_[h];
    return {{sine * std::sin(phi), cosine, -sine * std::cos(phi)},
            share / (2 * pi / width_ * (top - bottom))};
}

double EnvironmentMap::pdf(Vec3d d) const {
    const auto w = static_cast<std::size_t>(sampled_.width),
               h = static_cast<std::size_t>(sampled_.height);
    if (!(rowCdf_[h] > 0)) return 0;
    const double u = (0.5 + std::atan2(d.x, -d.z) / (2 * pi)) * width_;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * height_;
    const int x = std::min(static_cast<int>(std::max(0.0, u)), width_ - 1);
    const int y = std::min(static_cast<int>(std::max(0.0, v)), height_ - 1);
    const auto column = static_cast<std::size_t>((x - sampled_.x + width_) % width_);
    if (column >= w || y < sampled_.y || y >= sampled_.y + sampled_.height) return 0;
    const auto row = static_cast<std::size_t>(y - sampled_.y);
    const double top = std::cos(pi * y / height_), bottom = std::cos(pi * (y + 1) / height_);
    const double share =
        (columnCdf_[row * (w + 1) + column + 1] - columnCdf_[row * (w + 1) + column]) / rowCdf_[h];
    return share / (2 * pi / width_ * (top - bottom));
}

std::optional<EnvironmentMap::Sun> EnvironmentMap::takeSun() {
    constexpr double widest = 2 * pi / 180;  // from the brightest pixel
    constexpr float aboveMean = 10;          // what is so many times as bright as the image's mean
    constexpr double leastShare = 0.05;      // of all light
    if (empty()) return {};
    int brightX = 0, brightY = 0;
    float brightest = 0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
            if (const float mean = pixel(x, y).mean(); mean > brightest)
                brightest = mean, brightX = x, brightY = y;
    const Vec3d towards = direction(brightX + 0.5, brightY + 0.5);
    const auto isNear = [&](int x, int y) {
        return dot(direction(x + 0.5, y + 0.5), towards) > std::cos(widest);
    };
    const double sine = std::max(towards.y < 1 ? std::sqrt(1 - towards.y * towards.y) : 0.0, 1e-3);
    Window window;
    const int reachY = static_cast<int>(widest / pi * height_) + 1,
              reachX = static_cast<int>(
                  std::min(width_ / 2.0 - 1, widest / sine / (2 * pi) * width_ + 1));
    window.x = brightX - reachX, window.width = 2 * reachX + 1;
    window.y = std::max(0, brightY - reachY);
    window.height = std::min(height_, brightY + reachY + 1) - window.y;
    if (window.width > width_) return {};
    const Rgb sky = mean_ * aboveMean;
    const auto forEachBright = [&](auto&& take) {
        for (int y = window.y; y < window.y + window.height; ++y)
            for (int x = window.x; x < window.x + window.width; ++x)
                if (isNear(x, y) && pixel(x, y).mean() > sky.mean()) take(x, y, pixel(x, y));
    };
    const auto width = static_cast<std::size_t>(window.width);
    std::vector<float> taken(3 * width * static_cast<std::size_t>(window.height));
    Vec3d middle;
    forEachBright([&](int x, int y, Rgb p) {
        const std::size_t i = 3 * (static_cast<std::size_t>(y - window.y) * width +
                                   static_cast<std::size_t>(x - window.x));
        for (std::size_t c = 0; c < 3; ++c)
            taken[i + c] = std::max(0.0f, p[static_cast<int>(c)] - sky[static_cast<int>(c)]);
        middle = middle + direction(x + 0.5, y + 0.5) * double{p.mean()};
    });
    EnvironmentMap map(width_, height_, window, std::move(taken));
    if (!(map.mean_.mean() > leastShare * mean_.mean())) return {};
    forEachBright([&](int x, int y, Rgb p) {
        float* const left = find(x, y);
        for (int c = 0; c < 3; ++c) left[c] = std::min(p[c], sky[c]);
    });
    tabulate();
    return Sun{std::move(map), normalize(middle)};
}

}  // namespace woodcock::light
