// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/resample.h"

#include <algorithm>
#include <cmath>

namespace woodcock::compare {

namespace {

/// The pixels that make one, with their weights.
struct Share {
    int first = 0;
    std::vector<double> weights;  ///< their sum is 1
};

std::vector<Share> sharesOf(int from, int to) {
    std::vector<Share> shares;
    const double step = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
        const double begin = i * step, end = i + 1 == to ? from : (i + 1) * step;
        Share share{static_cast<int>(begin), {}};
        for (int k = share.first; k < from && k < end; ++k) {
            const double covered = std::min<double>(k + 1, end) - std::max<double>(k, begin);
            share.weights.push_back(covered / (end - begin));
        }
        shares.push_back(std::move(share));
    }
    return shares;
}

/// The variance of a mean over all pixels, divided by that for independent pixels.
double sharedNoise(const std::vector<Share>& shares, int from) {
    double squares = 0;
    for (const Share& share : shares)
        for (const double w : share.weights) squares += w * w;
    const auto n = static_cast<double>(shares.size());
    return (n * n / from) / squares;
}

/// Weighted sums; with `squared`, of independent numbers' variances.
std::vector<double> reduced(const std::vector<double>& in, int width,
                            const std::vector<Share>& columns, const std::vector<Share>& rows,
                            bool squared) {
    const auto w = static_cast<std::size_t>(width);
    std::vector<double> out(columns.size() * rows.size(), 0.0);
    for (std::size_t y = 0; y < rows.size(); ++y)
        for (std::size_t j = 0; j < rows[y].weights.size(); ++j)
            for (std::size_t x = 0; x < columns.size(); ++x)
                for (std::size_t i = 0; i < columns[x].weights.size(); ++i) {
                    const double weight = rows[y].weights[j] * columns[x].weights[i];
                    out[y * columns.size() + x] +=
                        (squared ? weight * weight : weight) *
                        in[(static_cast<std::size_t>(rows[y].first) + j) * w +
                           static_cast<std::size_t>(columns[x].first) + i];
                }
    return out;
}

}  // namespace

void shrink(Picture& picture, int width, int height) {
    if (picture.width == width && picture.height == height) return;
    const std::vector<Share> columns = sharesOf(picture.width, width),
                             rows = sharesOf(picture.height, height);
    for (ComparedPlane& plane : picture.planes) {
        for (std::vector<float>* means : {&plane.values, &plane.roundings}) {
            if (means->empty()) continue;
            const std::vector<double> values =
                reduced({means->begin(), means->end()}, picture.width, columns, rows, false);
            means->assign(values.begin(), values.end());
        }
        if (plane.errors.empty()) continue;
        std::vector<double> variances(plane.errors.begin(), plane.errors.end());
        for (double& v : variances) v *= v;
        variances = reduced(variances, picture.width, columns, rows, true);
        std::transform(variances.begin(), variances.end(), variances.begin(),
                       [](double v) { return std::sqrt(v); });
        plane.errors.assign(variances.begin(), variances.end());
    }
    picture.sharedNoise = sharedNoise(columns, picture.width) * sharedNoise(rows, picture.height);
    picture.width = width, picture.height = height;
}

}  // namespace woodcock::compare
