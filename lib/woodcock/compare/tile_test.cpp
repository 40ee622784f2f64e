// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/tile_test.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "woodcock/base/statistics.h"
#include "woodcock/compare/student_t.h"

namespace woodcock::compare {

Tiles::Tiles(int width, int height, int side)
    : width_(width),
      height_(height),
      columns_(std::max(1, width / side)),
      rows_(std::max(1, height / side)) {}

Tiles::Tile Tiles::tile(std::size_t index) const {
    const auto cut = [](int length, int parts, int i) {
        return static_cast<int>(static_cast<long long>(length) * i / parts);
    };
    const int x = static_cast<int>(index) % columns_, y = static_cast<int>(index) / columns_;
    return {cut(width_, columns_, x), cut(height_, rows_, y), cut(width_, columns_, x + 1),
            cut(height_, rows_, y + 1)};
}

double MeanDifference::chance() const {
    const double beyond = std::abs(value) - allowance;
    if (pixels == 0 || beyond <= 0) return 1;
    if (error <= 0) return pixels > 1 ? 0 : 1;
    return studentTwoSided(beyond / error, degrees);
}

namespace {

double roundingAt(const ComparedPlane& plane, std::size_t pixel) {
    return plane.roundings.empty() ? 0.0 : static_cast<double>(plane.roundings[pixel]);
}

}  // namespace

std::vector<MeanDifference> tileDifferences(const Picture& a, const ComparedPlane& planeA,
                                            const Picture& b, const ComparedPlane& planeB,
                                            const Tiles& tiles, double factor) {
    const bool known = !planeA.errors.empty() && !planeB.errors.empty();
    const double resolution = std::max(a.resolution, b.resolution);
    const double shared = std::max(a.sharedNoise, b.sharedNoise);
    std::vector<MeanDifference> found(tiles.count());
    for (std::size_t t = 0; t < found.size(); ++t) {
        const auto [x0, y0, x1, y1] = tiles.tile(t);
        Moments differences, unresolved;
        double variance = 0, perDegree = 0;  // sums of variances, and of their squares / degrees
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                               static_cast<std::size_t>(x);
                const double va = factor * static_cast<double>(planeA.values[i]),
                             vb = planeB.values[i];
                if (!std::isfinite(va) || !std::isfinite(vb)) continue;
                differences.add(vb - va);
                unresolved.add(std::max(resolution * std::max(std::abs(va), std::abs(vb)),
                                        roundingAt(planeA, i) + roundingAt(planeB, i)));
                if (!known) continue;
                const double ea = std::pow(factor * planeA.errors[i], 2),
                             eb = std::pow(static_cast<double>(planeB.errors[i]), 2);
                variance += ea + eb;
                perDegree += ea * ea / a.errorDegrees + eb * eb / b.errorDegrees;
            }
        const auto n = static_cast<double>(differences.count());
        MeanDifference& d = found[t];
        d.pixels = differences.count();
        d.value = differences.mean();
        d.allowance = unresolved.mean();
        if (known && n > 0) {
            d.error = std::sqrt(shared * variance) / n;
            d.degrees = variance * variance / perDegree;
        } else {
            d.error = std::sqrt(shared) * differences.standardError();
            d.degrees = n - 1;
        }
    }
    return found;
}

std::vector<MeanDifference> cautious(const std::vector<MeanDifference>& differences,
                                     const Tiles& tiles) {
    const auto pixelVariance = [](const MeanDifference& d) {
        return d.error * d.error * static_cast<double>(d.pixels);
    };
    std::vector<MeanDifference> found = differences;
    const int columns = tiles.columns(), rows = tiles.rows();
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            Moments around;
            for (int y = std::max(0, row - 1); y <= std::min(rows - 1, row + 1); ++y)
                for (int x = std::max(0, column - 1); x <= std::min(columns - 1, column + 1); ++x)
                    if (const auto& d = differences[static_cast<std::size_t>(y * columns + x)];
                        d.pixels > 1)
                        around.add(pixelVariance(d));
            MeanDifference& d = found[static_cast<std::size_t>(row * columns + column)];
            if (d.pixels > 0)
                d.error =
                    std::max(d.error, std::sqrt(around.mean() / static_cast<double>(d.pixels)));
        }
    return found;
}

MeanDifference overall(const std::vector<MeanDifference>& tiles) {
    MeanDifference all;
    double variance = 0, perDegree = 0;
    for (const MeanDifference& tile : tiles) {
        const auto n = static_cast<double>(tile.pixels);
        const double v = std::pow(n * tile.error, 2);
        all.pixels += tile.pixels;
        all.value += n * tile.value;
        all.allowance += n * tile.allowance;
        variance += v;
        if (v > 0) perDegree += v * v / tile.degrees;
    }
    if (all.pixels == 0) return all;
    const auto n = static_cast<double>(all.pixels);
    all.value /= n;
    all.allowance /= n;
    all.error = std::sqrt(variance) / n;
    all.degrees = variance * variance / perDegree;
    return all;
}

std::vector<bool> tooSmall(const std::vector<double>& chances, double rate) {
    std::vector<std::size_t> order(chances.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return chances[i] < chances[j]; });
    std::vector<bool> found(chances.size(), false);
    for (std::size_t k = 0; k < order.size(); ++k) {
        // 1 - (1 - rate)^(1 / left)
        const double bound = -std::expm1(std::log1p(-rate) / static_cast<double>(order.size() - k));
        if (chances[order[k]] > bound) break;
        found[order[k]] = true;
    }
    return found;
}

}  // namespace woodcock::compare
