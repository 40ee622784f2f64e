// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/metrics.h"

#include <algorithm>
#include <cmath>

namespace woodcock::compare {

namespace {

constexpr std::size_t kept = 5;

double size(const PixelDifference& d) { return std::abs(d.b - d.a); }

/// Keeps the largest; the first among equals.
void keep(std::vector<PixelDifference>& largest, const PixelDifference& d) {
    if (size(d) == 0 || (largest.size() == kept && size(d) <= size(largest.back()))) return;
    const auto place = std::upper_bound(
        largest.begin(), largest.end(), d,
        [](const PixelDifference& x, const PixelDifference& y) { return size(x) > size(y); });
    largest.insert(place, d);
    if (largest.size() > kept) largest.pop_back();
}

}  // namespace

DifferenceMetrics differenceMetrics(std::span<const float> a, std::span<const float> b, int width) {
    DifferenceMetrics m;
    double squares = 0, relative = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool fineA = std::isfinite(a[i]), fineB = std::isfinite(b[i]);
        if (!fineA) ++m.nonFiniteA;
        if (!fineB) ++m.nonFiniteB;
        if (fineA != fineB) ++m.nonFiniteInOne;
        if (!fineA || !fineB) continue;
        const double va = a[i], vb = b[i], d = vb - va;
        ++m.pixels;
        m.meanA += va;
        m.meanB += vb;
        squares += d * d;
        relative += d * d / (va * va + relMseEpsilon);
        m.peak = std::max(m.peak, std::abs(va));
        const auto w = static_cast<std::size_t>(width);
        keep(m.largest, {static_cast<int>(i % w), static_cast<int>(i / w), va, vb});
    }
    if (m.pixels == 0) return m;
    const auto n = static_cast<double>(m.pixels);
    m.meanA /= n;
    m.meanB /= n;
    m.rmse = std::sqrt(squares / n);
    m.relMse = relative / n;
    m.psnr = 20 * std::log10(m.peak / m.rmse);
    return m;
}

}  // namespace woodcock::compare
