// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/keyframes.h"

#include <algorithm>
#include <cmath>

namespace woodcock {

namespace {

/// The slopes of one number at its keys: Fritsch and Carlson 1980, sec. 4, with the harmonic mean
/// of Fritsch and Butland 1984, which lies in the region that keeps it monotone.
std::vector<double> monotoneSlopes(const std::vector<double>& x, const std::vector<double>& y) {
    const std::size_t n = x.size();
    std::vector<double> secant(n - 1), slope(n);
    for (std::size_t i = 0; i + 1 < n; ++i) secant[i] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    slope.front() = secant.front(), slope.back() = secant.back();
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double a = secant[i - 1], b = secant[i];
        if (!(a * b > 0)) continue;  // an extreme, or the end of a pause: level
        const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
        const double wa = (before + 2 * after) / (3 * (before + after));
        slope[i] = a * b / ((1 - wa) * a + wa * b);
    }
    return slope;
}

}  // namespace

Keyframes::Keyframes(std::vector<double> frames, std::vector<std::vector<double>> values,
                     Interpolation interpolation)
    : frames_(std::move(frames)), values_(std::move(values)), interpolation_(interpolation) {
    if (interpolation_ != Interpolation::Smooth || frames_.size() < 2) return;
    slopes_.assign(frames_.size(), std::vector<double>(values_.front().size()));
    std::vector<double> y(frames_.size());
    for (std::size_t c = 0; c < values_.front().size(); ++c) {
        for (std::size_t i = 0; i < y.size(); ++i) y[i] = values_[i][c];
        const std::vector<double> slope = monotoneSlopes(frames_, y);
        for (std::size_t i = 0; i < y.size(); ++i) slopes_[i][c] = slope[i];
    }
}

Keyframes::Place Keyframes::placeOf(double frame) const {
    if (frames_.size() < 2 || !(frame > frames_.front())) return {0, 0};
    const std::size_t last = frames_.size() - 2;
    if (frame >= frames_.back()) return {last, 1};
    const auto after = std::upper_bound(frames_.begin(), frames_.end(), frame);
    const auto key = static_cast<std::size_t>(after - frames_.begin()) - 1;
    return {key, (frame - frames_[key]) / (frames_[key + 1] - frames_[key])};
}

std::vector<double> Keyframes::at(double frame) const {
    const auto [key, s] = placeOf(frame);
    if (s == 0) return values_[key];
    if (s == 1) return values_[key + 1];
    const std::vector<double>&a = values_[key], &b = values_[key + 1];
    if (interpolation_ == Interpolation::Constant) return a;
    const double width = frames_[key + 1] - frames_[key];
    std::vector<double> y(a.size());
    for (std::size_t c = 0; c < a.size(); ++c) {
        if (a[c] == b[c]) {
            y[c] = a[c];
        } else if (interpolation_ == Interpolation::Linear) {
            y[c] = a[c] * (1 - s) + b[c] * s;
        } else {  // the cubic of Hermite's form
            const double r = 1 - s;
            y[c] = a[c] * r * r * (1 + 2 * s) + b[c] * s * s * (1 + 2 * r) +
                   width * s * r * (slopes_[key][c] * r - slopes_[key + 1][c] * s);
            y[c] = std::clamp(y[c], std::min(a[c], b[c]), std::max(a[c], b[c]));  // rounding
        }
    }
    return y;
}

}  // namespace woodcock
