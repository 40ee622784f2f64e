// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/film.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <type_traits>

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

template <typename Planes, typename Self>
Planes Film::planesOf(Self& film) {
    Planes planes;
    const auto list = [&](const char* name, auto& pixels, auto member) {
        if (pixels.empty()) return;
        auto& inFirst = pixels.front().*member;
        using Number = std::remove_all_extents_t<std::remove_reference_t<decltype(inFirst)>>;
        using Pixel = std::remove_reference_t<decltype(pixels.front())>;
        static_assert(sizeof(Pixel) % sizeof(Number) == 0);
        auto& plane = planes.emplace_back();
        plane.name = name;
        plane.components = static_cast<int>(sizeof(inFirst) / sizeof(Number));
        plane.stride = sizeof(Pixel) / sizeof(Number);
        auto* const first = reinterpret_cast<Number*>(&inFirst);
        if constexpr (std::is_same_v<std::remove_const_t<Number>, double>)
            plane.sums = first;
        else
            plane.counts = first;
    };
    list("radiance", film.pixels_, &Pixel::radiance);
    list("radianceSquared", film.pixels_, &Pixel::radianceSquared);
    list("alpha", film.pixels_, &Pixel::alpha);
    list("alphaSquared", film.pixels_, &Pixel::alphaSquared);
    list("events", film.pixels_, &Pixel::events);
    list("coverage", film.pixels_, &Pixel::coverage);
    list("transmittance", film.pixels_, &Pixel::transmittance);
    list("weightedDepth", film.pixels_, &Pixel::weightedDepth);
    list("depthWeight", film.pixels_, &Pixel::depthWeight);
    list("samples", film.pixels_, &Pixel::samples);
    list("depthSamples", film.pixels_, &Pixel::depthSamples);
    list("nonFinite", film.pixels_, &Pixel::nonFinite);
    list("catcherLit", film.surfacePixels_, &SurfacePixel::catcherLit);
    list("catcherUnlit", film.surfacePixels_, &SurfacePixel::catcherUnlit);
    list("catcherWeight", film.surfacePixels_, &SurfacePixel::catcherWeight);
    list("albedo", film.featurePixels_, &FeaturePixel::albedo);
    list("normal", film.featurePixels_, &FeaturePixel::normal);
    list("foreground", film.foregroundPixels_, &ForegroundPixel::radiance);
    list("foregroundSquared", film.foregroundPixels_, &ForegroundPixel::radianceSquared);
    return planes;
}

std::vector<Film::Plane> Film::planes() { return planesOf<std::vector<Plane>>(*this); }

std::vector<Film::ConstPlane> Film::planes() const {
    return planesOf<std::vector<ConstPlane>>(*this);
}

bool Film::isLike(const Film& other) const {
    const std::vector<ConstPlane> own = planes(), others = other.planes();
    return width_ == other.width_ && height_ == other.height_ && crop_ == other.crop_ &&
           std::equal(own.begin(), own.end(), others.begin(), others.end(),
                      [](const auto& a, const auto& b) { return a.name == b.name; });
}

Film::Kept Film::keptIn(const std::vector<std::string>& planes) {
    const auto has = [&](const char* name) {
        return std::find(planes.begin(), planes.end(), name) != planes.end();
    };
    return {
        .surfaces = has("catcherLit"), .features = has("albedo"), .background = has("foreground")};
}

std::size_t Film::bytesPerPixel(Kept kept) {
    return sizeof(Pixel) + (kept.surfaces ? sizeof(SurfacePixel) : 0) +
           (kept.features ? sizeof(FeaturePixel) : 0) +
           (kept.background ? sizeof(ForegroundPixel) : 0);
}

void Film::merge(const Film& other) {
    if (width_ != other.width_ || height_ != other.height_ || crop_ != other.crop_)
        throw usageError(
            "films of {} x {} and {} x {} pixels cannot be added, nor films with different crops",
            width_, height_, other.width_, other.height_);
    if (!isLike(other)) throw usageError("films that keep different sums cannot be added");
    const std::vector<Plane> own = planes();
    const std::vector<ConstPlane> others = other.planes();
    for (std::size_t i = 0; i < own.size(); ++i) {
        const Plane& to = own[i];
        const ConstPlane& from = others[i];
        const auto add = [&](auto* sums, const auto* more) {
            for (std::size_t p = 0; p < pixelCount() * to.stride; p += to.stride)
                for (std::size_t c = p; c < p + static_cast<std::size_t>(to.components); ++c)
                    sums[c] += more[c];
        };
        to.sums ? add(to.sums, from.sums) : add(to.counts, from.counts);
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
