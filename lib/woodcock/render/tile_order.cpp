// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/tile_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "woodcock/base/error.h"

namespace woodcock::render {

namespace {

/// A rank-1 lattice by the powers of the inverse plastic number. Points whose keys lie between any
/// two bounds are spread evenly over the plane: Roberts 2018, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", R2.
double keyOf(int column, int row) {
    constexpr double a = 0.7548776662466927, b = 0.5698402909980532;
    const double sum = a * column + b * row;
    return sum - std::floor(sum);
}

}  // namespace

std::vector<image::Film::Window> scatteredTiles(image::Film::Window crop, int size) {
    struct Keyed {
        double key;
        image::Film::Window tile;
    };
    std::vector<Keyed> keyed;
    for (int y = crop.y0 / size * size; y < crop.y1; y += size)
        for (int x = crop.x0 / size * size; x < crop.x1; x += size)
            keyed.push_back({keyOf(x / size, y / size),
                             {std::max(x, crop.x0), std::max(y, crop.y0),
                              std::min(x + size, crop.x1), std::min(y + size, crop.y1)}});
    std::stable_sort(keyed.begin(), keyed.end(),
                     [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    std::vector<image::Film::Window> tiles;
    tiles.reserve(keyed.size());
    for (const Keyed& k : keyed) tiles.push_back(k.tile);
    return tiles;
}

image::Film::Window pictureTile(image::Film::Window picture, int index, int count) {
    const double width = picture.width(), height = picture.height();
    int columns = 0;
    double best = 0;
    for (int c = 1; c <= count; ++c) {
        if (count % c != 0) continue;
        const double shape = std::abs(std::log(width / c / (height / (count / c))));
        if (columns == 0 || shape < best) columns = c, best = shape;
    }
    const int rows = count / columns;
    if (columns > picture.width() || rows > picture.height())
        throw usageError("{} tiles are too many for {} x {} pixels", count, picture.width(),
                         picture.height());
    const auto cut = [](int from, int size, int i, int n) {
        return from + static_cast<int>(std::int64_t{size} * i / n);
    };
    const int column = index % columns, row = index / columns;
    return {cut(picture.x0, picture.width(), column, columns),
            cut(picture.y0, picture.height(), row, rows),
            cut(picture.x0, picture.width(), column + 1, columns),
            cut(picture.y0, picture.height(), row + 1, rows)};
}

}  // namespace woodcock::render
