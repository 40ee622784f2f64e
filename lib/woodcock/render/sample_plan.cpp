// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/sample_plan.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace woodcock::render {

namespace {

/// Bounds of a pixel's share, in means: the pilot may have missed rare bright samples, and one
/// bright sample must not give all samples to its neighbours.
constexpr double leastShare = 0.125, mostShare = 16;
/// Below this part of the mean brightness, errors count absolutely.
constexpr double darkness = 0.1;
/// Times the mean brightness: no pixel counts for more in that mean, or a light in sight would set
/// it.
constexpr double brightest = 4;

/// The cost of a scattering with its shadow ray and the flight after it, in units of a path without
/// scattering. Measured 3.5 in a baked cumulus, 4.5 in thin smoke, 6.5 to 9.6 in dense smoke in a
/// picture that is mostly sky (tests/bench/adaptive_bench). It is rather too high: then a picture
/// takes less time than with uniform samples, and not more.
constexpr double costOfAnEvent = 10;
constexpr double costUnits = 8;  // of a path without events

/// The pilot's findings in a pixel, or weighted sums of several pixels.
struct Found {
    double variance = 0;    ///< of a sample, mean over channels
    double radiance = 0;    ///< mean over channels
    double foreground = 0;  ///< the same without the background
    double coverage = 0, events = 0, weight = 0;

    static Found of(const image::Film& film, int x, int y) {
        const image::Film::Pixel& p = film.at(x, y);
        const auto n = static_cast<double>(p.samples);
        if (n < 2) return {};
        Found f{.events = p.events / n, .weight = 1};
        for (std::size_t c = 0; c < 3; ++c) {
            const double m = p.radiance[c] / n;
            f.radiance += m / 3;
            f.variance += std::max(0.0, (p.radianceSquared[c] - n * m * m) / (n - 1)) / 3;
        }
        const image::Film::Foreground shown = film.foreground(x, y);
        f.foreground = shown.radiance, f.coverage = std::min(1.0, shown.coverage);
        return f;
    }
};

/// Mean brightness of the pixels of one colour of the chessboard.
struct Brightness {
    double foreground = 0;  ///< of what covers a pixel: the mean by coverage
    double picture = 0;
};

Brightness brightnessOf(const std::vector<Found>& pixels, int width, std::size_t colour) {
    double covered = 0, light = 0, all = 0, number = 0;
    const auto each = [&](auto&& f) {
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const auto w = static_cast<std::size_t>(width);
            if (((i % w + i / w) & 1) == colour) f(pixels[i]);
        }
    };
    each([&](const Found& p) {
        covered += p.coverage, light += p.foreground;
        all += p.radiance, number += p.weight;
    });
    Brightness b;
    if (number > 0) b.picture = all / number;
    if (!(covered > 0)) return b;
    const double most = brightest * light / covered;
    each([&](const Found& p) {
        b.foreground += std::min(p.foreground, most * p.coverage) / covered;
    });
    return b;
}

/// Sums over pixels of one colour around a pixel of the other.
struct Neighbourhood {
    double variance = 0, square = 0, events = 0, weight = 0;

    /// `b`: that of the neighbours' colour. It sums squares, not means: beside a bright object, its
    /// faint rim then counts as much on both sides.
    void add(const Found& p, double w, const Brightness& b, double samples) {
        const double before = p.foreground + (1 - p.coverage) * b.foreground;
        const double seen = std::max(p.radiance, before);
        variance += w * p.variance;
        square += w * (seen * seen - p.variance / samples);
        events += w * p.events, weight += w;
    }
    /// Cost of a sample, in paths without events.
    double cost() const { return weight > 0 ? 1 + costOfAnEvent * events / weight : 1; }
    double relativeVariance(double epsilon) const {
        const double all = std::max(0.0, square) + epsilon * epsilon * weight;
        return all > 0 ? variance / all : 0;
    }
};

}  // namespace

SamplePlan::SamplePlan(const image::Film& pilot, int samples)
    : pixels_(static_cast<std::size_t>(pilot.crop().width()) *
              static_cast<std::size_t>(pilot.crop().height())),
      pilot_(static_cast<std::uint32_t>(samples)) {
    const image::Film::Window crop = pilot.crop();
    const int width = crop.width(), height = crop.height();
    const auto indexOf = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    };
    std::vector<Found> found(pixels_);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x)
            found[indexOf(x, y)] = Found::of(pilot, crop.x0 + x, crop.y0 + y);
    });
    const Brightness brightness[2]{brightnessOf(found, width, 0), brightnessOf(found, width, 1)};

    std::vector<PixelPlan> places(pixels_);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            // From the pixels of the other colour only, by binomial weights: enough pixels that
            // rare bright samples do not dominate.
            constexpr int reach = 6;
            constexpr std::array<double, reach + 1> binomial{924, 792, 495, 220, 66, 12, 1};
            const Brightness& b = brightness[(x + y + 1) & 1];
            Neighbourhood around;
            for (int v = std::max(y - reach, 0); v < std::min(y + reach + 1, height); ++v)
                for (int u = std::max(x - reach, 0); u < std::min(x + reach + 1, width); ++u) {
                    const Found& p = found[indexOf(u, v)];
                    if ((u + v + x + y) % 2 != 0 && p.weight > 0)
                        around.add(p,
                                   binomial[static_cast<std::size_t>(std::abs(u - x))] *
                                       binomial[static_cast<std::size_t>(std::abs(v - y))],
                                   b, samples);
                }
            const double epsilon = darkness * std::max(b.foreground, b.picture);
            const double cost = around.cost();
            places[indexOf(x, y)] = {indexOf(x, y),
                                     std::sqrt(around.relativeVariance(epsilon) / cost),
                                     static_cast<std::uint64_t>(std::lround(costUnits * cost))};
        }
    });
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) colours_[(x + y) & 1].push_back(places[indexOf(x, y)]);
    for (std::vector<PixelPlan>& ofColour : colours_) {
        double sum = 0;
        for (const PixelPlan& p : ofColour) sum += p.share;
        for (PixelPlan& p : ofColour) {
            const double relative =
                sum > 0 ? p.share * static_cast<double>(ofColour.size()) / sum : 1;
            p.share = std::clamp(relative, leastShare, mostShare);
        }
    }
}

SamplePlan::SamplePlan(int width, int samples, const std::vector<Weight>& weights)
    : pixels_(weights.size()), pilot_(static_cast<std::uint32_t>(samples)) {
    const auto w = static_cast<std::size_t>(width);
    for (std::size_t i = 0; i < pixels_; ++i)
        colours_[(i % w + i / w) & 1].push_back({i, weights[i].share, weights[i].cost});
}

std::vector<SamplePlan::Weight> SamplePlan::weights() const {
    std::vector<Weight> weights(pixels_);
    for (const std::vector<PixelPlan>& places : colours_)
        for (const PixelPlan& p : places) weights[p.pixel] = {p.share, p.cost};
    return weights;
}

int SamplePlan::pilotOf(int samples) { return std::clamp(samples / 4, 4, 32); }

std::vector<std::uint32_t> SamplePlan::counts(int even) const {
    std::vector<std::uint32_t> counts(pixels_, pilot_);
    if (static_cast<std::uint32_t>(even) <= pilot_)
        return std::vector<std::uint32_t>(pixels_, static_cast<std::uint32_t>(even));
    for (const std::vector<PixelPlan>& places : colours_) apportion(places, even, counts);
    return counts;
}

/// Webster's apportionment: a pixel gets its share x factor, rounded, and at least the pilot. The
/// factor rises until all work is distributed, so with more work no pixel ever gets less.
void SamplePlan::apportion(const std::vector<PixelPlan>& places, int even,
                           std::vector<std::uint32_t>& counts) const {
    if (places.empty()) return;
    const auto count = [&](const PixelPlan& p, double factor) {
        return std::max(pilot_, static_cast<std::uint32_t>(p.share * factor + 0.5));
    };
    const auto work = [&](double factor) {
        std::uint64_t s = 0;
        for (const PixelPlan& p : places) s += count(p, factor) * p.cost;
        return s;
    };
    std::uint64_t all = 0;
    for (const PixelPlan& p : places) all += p.cost;
    all *= static_cast<std::uint64_t>(even);
    double low = 0, high = 1;
    while (work(high) <= all) low = high, high *= 2;
    while (true) {  // the least factor that distributes too much, and the one before it
        const double middle = low + (high - low) / 2;
        if (!(low < middle && middle < high)) break;
        (work(middle) <= all ? low : high) = middle;
    }
    std::uint64_t left = all - work(low);
    bool fits = true;  // in the pixels' order up to the first that does not fit, so that more work
                       // never means less
    for (const PixelPlan& p : places) {
        counts[p.pixel] = count(p, low);
        if (count(p, high) == counts[p.pixel] || !fits) continue;
        fits = left >= p.cost;
        if (fits) ++counts[p.pixel], left -= p.cost;
    }
}

}  // namespace woodcock::render
