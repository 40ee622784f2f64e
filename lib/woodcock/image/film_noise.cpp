// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "woodcock/image/film.h"

namespace woodcock::image {

namespace {

/// The part of the mean brightness that is added, in squares, to the brightness to which an error
/// is relative.
constexpr double darkness = 0.1;
/// Times the mean brightness: no pixel counts for more in that mean, or a light in sight would set
/// it.
constexpr double brightest = 4;

double unknown() { return std::numeric_limits<double>::infinity(); }

/// The scene in the pixels of a film, row by row.
class Shown {
public:
    explicit Shown(const Film& film) : width_(film.crop().width()), height_(film.crop().height()) {
        const Film::Window crop = film.crop();
        pixels_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        double light = 0;
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x) {
                const auto samples = film.at(x, y).samples;
                const Film::Foreground f = film.foreground(x, y);
                Pixel p{static_cast<float>(f.radiance), -1, static_cast<float>(f.coverage),
                        static_cast<float>(f.alpha)};
                if (samples > 1) {
                    p.error =
                        static_cast<float>(std::sqrt(f.variance / static_cast<double>(samples)));
                    any_ = true, light += f.radiance, coverage_ += f.coverage;
                }
                pixels_.push_back(p);
            }
        if (!(coverage_ > 0 && light > 0)) return;
        const double most = brightest * light / coverage_;
        for (const Pixel& p : pixels_)
            if (p.known())
                mean_ += std::min(double{p.radiance}, most * double{p.coverage}) / coverage_;
    }

    bool any() const { return any_; }
    double coverage() const { return coverage_; }
    double meanBrightness() const { return mean_; }

    double noise() const {
        double errors = 0, weights = 0;
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const Pixel& p = at(x, y);
                if (!p.known() || !(p.coverage > 0)) continue;
                const auto [radiance, coverage] = meanAround(x, y);
                const double behind = (1 - std::min(1.0, coverage)) * mean_;
                const double relative =
                    double{p.error} / std::hypot(radiance + behind, darkness * mean_);
                const double weight =
                    std::max(double{p.alpha}, std::min(double{p.coverage}, radiance / mean_));
                errors += weight * relative * relative;
                weights += weight;
            }
        return weights > 0 ? std::sqrt(errors / weights) : unknown();
    }

private:
    struct Pixel {
        float radiance, error, coverage, alpha;
        bool known() const { return error >= 0; }
    };
    struct Around {
        double radiance = 0, coverage = 0;
    };
    const Pixel& at(int x, int y) const {
        return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x)];
    }
    /// Mean of the pixel and the eight around it: a pixel that holds a rare bright sample, or
    /// missed it, tells little about itself.
    Around meanAround(int x, int y) const {
        Around sum;
        double pixels = 0;
        for (int v = std::max(y - 1, 0); v < std::min(y + 2, height_); ++v)
            for (int u = std::max(x - 1, 0); u < std::min(x + 2, width_); ++u) {
                const Pixel& p = at(u, v);
                if (!p.known()) continue;
                sum.radiance += double{p.radiance}, sum.coverage += double{p.coverage};
                ++pixels;
            }
        return {sum.radiance / pixels, sum.coverage / pixels};
    }

    int width_, height_;
    std::vector<Pixel> pixels_;
    bool any_ = false;
    double coverage_ = 0, mean_ = 0;
};

/// Relative to a white background.
double noiseOfAlpha(const Film& film) {
    const Film::Window crop = film.crop();
    double errors = 0, weights = 0;
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const Film::Pixel& p = film.at(x, y);
            if (p.samples < 2) continue;
            const auto n = static_cast<double>(p.samples);
            const double alpha = p.alpha / n;
            const double variance = std::max(0.0, (p.alphaSquared - alpha * p.alpha) / (n - 1));
            errors += alpha * variance / n, weights += alpha;
        }
    return std::sqrt(errors / weights);
}

}  // namespace

double Film::noise() const {
    const Shown shown(*this);
    if (!shown.any()) return unknown();
    if (!(shown.coverage() > 0)) return 0;
    if (shown.meanBrightness() > 0) return shown.noise();
    const bool absorbsOnly =
        surfacePixels_.empty() &&
        std::all_of(pixels_.begin(), pixels_.end(), [](const Pixel& p) { return !(p.events > 0); });
    return absorbsOnly ? noiseOfAlpha(*this) : unknown();
}

}  // namespace woodcock::image
