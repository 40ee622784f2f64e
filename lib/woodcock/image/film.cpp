// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/film.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>

#include "woodcock/base/error.h"
#include "woodcock/base/huge_pages.h"

namespace woodcock::image {

Film::Film(int width, int height, Window crop, Kept kept)
    : width_(width), height_(height), crop_(crop), parts_(std::move(kept.parts)) {
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
    const auto make = [&](auto& pixels, std::size_t ofPixel = 1) {
        reserveLarge(pixels, count * ofPixel);
        pixels.resize(count * ofPixel);
    };
    make(pixels_);
    if (kept.surfaces) make(surfacePixels_);
    if (kept.features) make(featurePixels_);
    if (kept.background) make(foregroundPixels_);
    if (kept.places) make(placePixels_);
    if (kept.stops) make(stopPixels_);
    if (parts_.count() > 0) make(partSums_, 3 * parts_.count());
}

std::size_t Film::index(int x, int y) const {
    assert(x >= crop_.x0 && x < crop_.x1 && y >= crop_.y0 && y < crop_.y1);
    return static_cast<std::size_t>(y - crop_.y0) * static_cast<std::size_t>(crop_.width()) +
           static_cast<std::size_t>(x - crop_.x0);
}

Film::Pixel& Film::at(int x, int y) { return pixels_[index(x, y)]; }

const Film::Pixel& Film::at(int x, int y) const { return pixels_[index(x, y)]; }

void Film::add(int x, int y, const FilmSample& sample, std::span<const Rgb> parts) {
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
    if (!parts.empty()) {
        assert(parts.size() == parts_.count());
        double* sum = &partSums_[index(x, y) * 3 * parts.size()];
        for (const Rgb& part : parts)
            for (int c = 0; c < 3; ++c) *sum++ += part[c];
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

void Film::add(int x, int y, const DepthSample& sample, const PlaceSample& place) {
    const std::uint64_t before = at(x, y).depthSamples;
    add(x, y, sample);
    if (at(x, y).depthSamples == before) return;  // it was not finite
    PlacePixel& p = placePixels_.at(index(x, y));
    for (int i = 0; i < 3; ++i) p.position[i] += place.weightedPosition[i];
    for (std::size_t i = 0; i < 2; ++i) p.motion[i] += double{place.weightedMotion[i]};
}

void Film::add(int x, int y, const StopSample& sample) {
    StopPixel& s = stopPixels_.at(index(x, y));
    s.firstDepth += sample.firstDepth;
    s.firstDepthWeight += sample.firstWeight;
    s.halfDepth += sample.halfDepth;
    s.halfDepthWeight += sample.halfWeight;
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
    list("position", film.placePixels_, &PlacePixel::position);
    list("motion", film.placePixels_, &PlacePixel::motion);
    list("firstDepth", film.stopPixels_, &StopPixel::firstDepth);
    list("firstDepthWeight", film.stopPixels_, &StopPixel::firstDepthWeight);
    list("halfDepth", film.stopPixels_, &StopPixel::halfDepth);
    list("halfDepthWeight", film.stopPixels_, &StopPixel::halfDepthWeight);
    for (std::size_t part = 0; part < film.parts_.count(); ++part)
        planes.push_back({.name = film.parts_.name(part),
                          .components = 3,
                          .stride = 3 * film.parts_.count(),
                          .sums = &film.partSums_[3 * part]});
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
    const auto has = [&](const std::string& name) {
        return std::find(planes.begin(), planes.end(), name) != planes.end();
    };
    Kept kept{.surfaces = has("catcherLit"),
              .features = has("albedo"),
              .background = has("foreground"),
              .places = has("position"),
              .stops = has("firstDepth")};
    kept.parts.kinds = has(lightKindNames.front());
    for (const std::string& plane : planes)
        if (plane.starts_with(groupPrefix) && plane != groupPrefix + restOfGroups)
            kept.parts.groups.push_back(plane.substr(groupPrefix.size()));
    return kept;
}

std::size_t Film::bytesPerPixel(const Kept& kept) {
    return sizeof(Pixel) + (kept.surfaces ? sizeof(SurfacePixel) : 0) +
           (kept.features ? sizeof(FeaturePixel) : 0) +
           (kept.background ? sizeof(ForegroundPixel) : 0) +
           (kept.places ? sizeof(PlacePixel) : 0) + (kept.stops ? sizeof(StopPixel) : 0) +
           kept.parts.count() * 3 * sizeof(double);
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

}  // namespace woodcock::image
