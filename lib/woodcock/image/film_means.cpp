// SPDX-License-Identifier: Apache-2.0
// What pictures and their layers show of a film's sums.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "woodcock/image/film.h"

namespace woodcock::image {

namespace {

Rgb mean(const double (&sum)[3], std::uint64_t n) {
    if (n == 0) return Rgb(0.0f);
    return Rgb::map([&](int i) { return static_cast<float>(sum[i] / static_cast<double>(n)); });
}

using Variance = std::array<double, 3>;  // of one sample
constexpr Variance unknownVariance{-1, -1, -1};

Variance sampleVariance(const double (&sums)[3], const double (&squares)[3],
                        std::uint64_t samples) {
    if (samples < 2) return unknownVariance;
    const auto n = static_cast<double>(samples);
    Variance variance;
    for (std::size_t c = 0; c < 3; ++c)
        // Equal samples may leave a difference below zero by rounding.
        variance[c] = std::max(0.0, (squares[c] - sums[c] * (sums[c] / n)) / (n - 1));
    return variance;
}
Variance sampleVariance(const Film::Pixel& p) {
    return sampleVariance(p.radiance, p.radianceSquared, p.samples);
}

Rgb errorOfMean(const Variance& variance, std::uint64_t samples) {
    return Rgb::map([&](int i) {
        return static_cast<float>(
            std::sqrt(variance[static_cast<std::size_t>(i)] / static_cast<double>(samples)));
    });
}

}  // namespace

Rgb Film::radiance(int x, int y) const {
    const Pixel& p = at(x, y);
    return mean(p.radiance, p.samples);
}

float Film::alpha(int x, int y) const {
    const Pixel& p = at(x, y);
    if (p.samples == 0) return 0;
    double alpha = p.alpha;
    if (!surfacePixels_.empty()) {
        const SurfacePixel& s = surfacePixels_[index(x, y)];
        if (s.catcherUnlit > 0)
            alpha += s.catcherWeight * std::max(0.0, 1 - s.catcherLit / s.catcherUnlit);
    }
    return static_cast<float>(alpha / static_cast<double>(p.samples));
}

Rgb Film::transmittance(int x, int y) const {
    const Pixel& p = at(x, y);
    return mean(p.transmittance, p.depthSamples);
}

Rgb Film::standardError(int x, int y) const {
    Variance variance = sampleVariance(at(x, y));
    if (variance[0] < 0) return Rgb(std::numeric_limits<float>::infinity());
    Variance around{};
    int pixels = 0;
    for (int v = std::max(y - 1, crop_.y0); v < std::min(y + 2, crop_.y1); ++v)
        for (int u = std::max(x - 1, crop_.x0); u < std::min(x + 2, crop_.x1); ++u) {
            const Variance other = sampleVariance(at(u, v));
            if (other[0] < 0) continue;
            for (std::size_t c = 0; c < 3; ++c) around[c] += other[c];
            ++pixels;
        }
    for (std::size_t c = 0; c < 3; ++c) variance[c] = std::max(variance[c], around[c] / pixels);
    return errorOfMean(variance, at(x, y).samples);
}

Rgb Film::variance(int x, int y) const {
    const Rgb error = standardError(x, y);
    return error * error;
}

float Film::depth(int x, int y) const {
    const Pixel& p = at(x, y);
    return p.depthWeight > 0 ? static_cast<float>(p.weightedDepth / p.depthWeight) : noDepth;
}

Rgb Film::albedo(int x, int y) const {
    if (featurePixels_.empty()) return {};
    const Rgb albedo = mean(featurePixels_[index(x, y)].albedo, at(x, y).depthSamples);
    // Where channels differ, the weights of single rays may exceed 1, and so may a few rays' mean.
    return Rgb::map([&](int c) { return std::min(albedo[c], 1.0f); });
}

Vec3f Film::normal(int x, int y) const {
    if (featurePixels_.empty()) return {};
    const Rgb n = mean(featurePixels_[index(x, y)].normal, at(x, y).depthSamples);
    return {n[0], n[1], n[2]};
}

Rgb Film::part(std::size_t place, int x, int y) const {
    const double* sum = &partSums_[3 * (index(x, y) * parts_.count() + place)];
    return mean({sum[0], sum[1], sum[2]}, at(x, y).samples);
}

Rgb Film::light(LightKind kind, int x, int y) const {
    return parts_.kindCount() == 0 ? Rgb() : part(parts_.placeOf(kind), x, y);
}

Rgb Film::lightOfGroup(LightGroup group, int x, int y) const {
    return group < parts_.groupCount() ? part(parts_.placeOf(group), x, y) : Rgb();
}

Vec3f Film::position(int x, int y) const {
    const double weight = at(x, y).depthWeight;
    if (placePixels_.empty() || !(weight > 0)) return {};
    const auto& sum = placePixels_[index(x, y)].position;
    return Vec3d{sum[0] / weight, sum[1] / weight, sum[2] / weight}.as<float>();
}

std::array<float, 2> Film::motion(int x, int y) const {
    const double weight = at(x, y).depthWeight;
    if (placePixels_.empty() || !(weight > 0)) return {};
    const auto& sum = placePixels_[index(x, y)].motion;
    return {static_cast<float>(sum[0] / weight), static_cast<float>(sum[1] / weight)};
}

float Film::firstDepth(int x, int y) const {
    if (stopPixels_.empty()) return noDepth;
    const StopPixel& s = stopPixels_[index(x, y)];
    return s.firstDepthWeight > 0 ? static_cast<float>(s.firstDepth / s.firstDepthWeight) : noDepth;
}

float Film::halfDepth(int x, int y) const {
    if (stopPixels_.empty()) return noDepth;
    const StopPixel& s = stopPixels_[index(x, y)];
    return s.halfDepthWeight > 0 ? static_cast<float>(s.halfDepth / s.halfDepthWeight) : noDepth;
}

Film::Foreground Film::foreground(int x, int y) const {
    const Pixel& p = at(x, y);
    if (p.samples == 0) return {};
    const auto n = static_cast<double>(p.samples);
    const ForegroundPixel* const own =
        foregroundPixels_.empty() ? nullptr : &foregroundPixels_[index(x, y)];
    const auto& radiance = own ? own->radiance : p.radiance;
    const Variance variance =
        sampleVariance(radiance, own ? own->radianceSquared : p.radianceSquared, p.samples);
    Foreground f{.coverage = p.coverage / n, .alpha = p.alpha / n};
    for (std::size_t c = 0; c < 3; ++c) {
        f.radiance += radiance[c] / n / 3;
        f.variance += std::max(0.0, variance[c]) / 3;
    }
    return f;
}

}  // namespace woodcock::image
