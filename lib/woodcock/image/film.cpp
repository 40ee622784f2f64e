// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/film.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/base/huge_pages.h"

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

Film::Film(int width, int height, Window crop, Kept kept)
    : width_(width), height_(height), crop_(crop) {
    if (width <= 0 || height <= 0)
        throw usageError("an image of {} x {} pixels is empty", width, height);
    if (crop.width() <= 0 || crop.height() <= 0)
        throw usageError(
            "the crop from ({}, {}) to ({}, {}) is empty: its end must lie beyond its start (the "
            "end itself is not part of it)",
            crop.x0, crop.y0, crop.x1, crop.y1);
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > width || crop.y1 > height)
        throw usageError(
            "the crop from ({}, {}) to ({}, {}) reaches beyond the image of {} x {} pixels",
            crop.x0, crop.y0, crop.x1, crop.y1, width, height);
    const std::size_t count =
        static_cast<std::size_t>(crop.width()) * static_cast<std::size_t>(crop.height());
    const auto make = [&](auto& pixels) {
        reserveLarge(pixels, count);
        pixels.resize(count);
    };
    make(pixels_);
    if (kept.surfaces) make(surfacePixels_);
    if (kept.features) make(featurePixels_);
    if (kept.background) make(foregroundPixels_);
}

std::size_t Film::index(int x, int y) const {
    assert(x >= crop_.x0 && x < crop_.x1 && y >= crop_.y0 && y < crop_.y1);
    return static_cast<std::size_t>(y - crop_.y0) * static_cast<std::size_t>(crop_.width()) +
           static_cast<std::size_t>(x - crop_.x0);
}

Film::Pixel& Film::at(int x, int y) { return pixels_[index(x, y)]; }

const Film::Pixel& Film::at(int x, int y) const { return pixels_[index(x, y)]; }

void Film::add(int x, int y, const FilmSample& sample) {
    Pixel& p = at(x, y);
    if (!sample.radiance.isFinite() || !std::isfinite(sample.alpha)) {
        ++p.nonFinite;
        return;
    }
    for (int i = 0; i < 3; ++i) {
        const double v = sample.radiance[i];
        p.radiance[i] += v;
        p.radianceSquared[i] += v * v;
    }
    if (!foregroundPixels_.empty()) {
        ForegroundPixel& f = foregroundPixels_[index(x, y)];
        for (int i = 0; i < 3; ++i) {
            const double v = double{sample.radiance[i]} - double{sample.background[i]};
            f.radiance[i] += v;
            f.radianceSquared[i] += v * v;
        }
    }
    const double alpha = sample.alpha;
    p.alpha += alpha;
    p.alphaSquared += alpha * alpha;
    p.coverage += std::max(alpha, double{sample.glow});
    p.events += sample.events;
    ++p.samples;
}

void Film::add(int x, int y, const DepthSample& sample) {
    Pixel& p = at(x, y);
    if (!sample.transmittance.isFinite() || !std::isfinite(sample.weightedDepth) ||
        !std::isfinite(sample.weight)) {
        ++p.nonFinite;
        return;
    }
    for (int i = 0; i < 3; ++i) p.transmittance[i] += sample.transmittance[i];
    p.weightedDepth += sample.weightedDepth;
    p.depthWeight += sample.weight;
    ++p.depthSamples;
    if (featurePixels_.empty()) return;
    FeaturePixel& f = featurePixels_[index(x, y)];
    for (int i = 0; i < 3; ++i) {
        f.albedo[i] += sample.weightedAlbedo[i];
        f.normal[i] += sample.weightedNormal[i];
    }
}

void Film::add(int x, int y, const CatcherSample& sample) {
    Pixel& p = at(x, y);
    if (!std::isfinite(sample.lit) || !std::isfinite(sample.unlit)) {
        ++p.nonFinite;
        return;
    }
    SurfacePixel& s = surfacePixels_.at(index(x, y));
    s.catcherLit += sample.lit;
    s.catcherUnlit += sample.unlit;
    s.catcherWeight += sample.weight;
}

void Film::merge(const Film& other) {
    if (width_ != other.width_ || height_ != other.height_ || crop_ != other.crop_)
        throw usageError(
            "films of {} x {} and {} x {} pixels cannot be added, nor films with different crops",
            width_, height_, other.width_, other.height_);
    if (foregroundPixels_.size() != other.foregroundPixels_.size())
        throw usageError("a film with a visible background and one without it cannot be added");
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        Pixel& p = pixels_[i];
        const Pixel& q = other.pixels_[i];
        for (int c = 0; c < 3; ++c) {
            p.radiance[c] += q.radiance[c];
            p.radianceSquared[c] += q.radianceSquared[c];
            p.transmittance[c] += q.transmittance[c];
        }
        p.alpha += q.alpha;
        p.alphaSquared += q.alphaSquared;
        p.coverage += q.coverage;
        p.events += q.events;
        p.weightedDepth += q.weightedDepth;
        p.depthWeight += q.depthWeight;
        p.samples += q.samples;
        p.depthSamples += q.depthSamples;
        p.nonFinite += q.nonFinite;
    }
    if (surfacePixels_.empty()) surfacePixels_.resize(other.surfacePixels_.size());
    for (std::size_t i = 0; i < other.surfacePixels_.size(); ++i) {
        SurfacePixel& p = surfacePixels_[i];
        const SurfacePixel& q = other.surfacePixels_[i];
        p.catcherLit += q.catcherLit;
        p.catcherUnlit += q.catcherUnlit;
        p.catcherWeight += q.catcherWeight;
    }
    if (featurePixels_.empty()) featurePixels_.resize(other.featurePixels_.size());
    for (std::size_t i = 0; i < other.featurePixels_.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            featurePixels_[i].albedo[c] += other.featurePixels_[i].albedo[c];
            featurePixels_[i].normal[c] += other.featurePixels_[i].normal[c];
        }
    for (std::size_t i = 0; i < foregroundPixels_.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            foregroundPixels_[i].radiance[c] += other.foregroundPixels_[i].radiance[c];
            foregroundPixels_[i].radianceSquared[c] +=
                other.foregroundPixels_[i].radianceSquared[c];
        }
}

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

std::uint64_t Film::nonFiniteCount() const {
    std::uint64_t count = 0;
    for (const Pixel& p : pixels_) count += p.nonFinite;
    return count;
}

std::uint64_t Film::pixelsWithoutSamples() const {
    return static_cast<std::uint64_t>(
        std::count_if(pixels_.begin(), pixels_.end(),
                      [](const Pixel& p) { return p.samples + p.nonFinite == 0; }));
}

std::uint64_t Film::mostSamples() const {
    std::uint64_t most = 0;
    for (const Pixel& p : pixels_) most = std::max(most, p.samples);
    return most;
}

double Film::meanSamples() const {
    double sum = 0;
    for (const Pixel& p : pixels_) sum += static_cast<double>(p.samples);
    return sum / static_cast<double>(pixels_.size());
}

std::uint64_t Film::fewestSamples() const {
    std::uint64_t fewest = pixels_.front().samples;
    for (const Pixel& p : pixels_) fewest = std::min(fewest, p.samples);
    return fewest;
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
