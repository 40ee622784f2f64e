// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/tile_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "tests/support/expect_error.h"

namespace woodcock::test {

using namespace image;
using namespace render;

namespace {

TEST(TileOrder, EveryPixelIsInOneTile) {
    for (const Film::Window crop :
         {Film::Window{0, 0, 1, 1}, {0, 0, 64, 48}, {5, 17, 100, 83}, {31, 0, 33, 200}}) {
        std::vector<int> covered(static_cast<std::size_t>(crop.width() * crop.height()));
        for (const Film::Window& t : scatteredTiles(crop, 16)) {
            EXPECT_LE(t.width(), 16);
            EXPECT_LE(t.height(), 16);
            for (int y = t.y0; y < t.y1; ++y)
                for (int x = t.x0; x < t.x1; ++x)
                    ++covered.at(
                        static_cast<std::size_t>((y - crop.y0) * crop.width() + x - crop.x0));
        }
        EXPECT_EQ(covered, std::vector<int>(covered.size(), 1));
    }
}

/// Costs of tiles at (x, y) in [0, 1)^2.
using Costs = std::function<double(double x, double y)>;
const std::vector<std::pair<const char*, Costs>>& unevenPictures() {
    static const std::vector<std::pair<const char*, Costs>> pictures{
        {"sky on top", [](double, double y) { return y < 0.6 ? 1.0 : 30.0; }},
        {"smoke in the middle",
         [](double x, double y) { return std::hypot(x - 0.5, y - 0.5) < 0.25 ? 40.0 : 1.0; }},
        {"a column", [](double x, double) { return x > 0.7 && x < 0.8 ? 50.0 : 1.0; }},
        {"a ramp", [](double x, double y) { return 1 + 10 * x + 20 * y; }},
        {"smoke in a corner", [](double x, double y) { return x + y < 0.4 ? 40.0 : 1.0; }}};
    return pictures;
}

TEST(TileOrder, WhatTheFirstTilesCostIsWhatAllCost) {
    for (const auto& [width, height] : {std::pair{1920, 1080}, {960, 540}, {3840, 2160}})
        for (const auto& [name, cost] : unevenPictures()) {
            std::vector<double> costs;
            for (const Film::Window& t : scatteredTiles({0, 0, width, height}, 16))
                costs.push_back(cost(double(t.x0) / width, double(t.y0) / height));
            const double all = std::accumulate(costs.begin(), costs.end(), 0.0);
            // Any tenth of the order: threads start in different places of it.
            const std::size_t tenth = costs.size() / 10;
            for (std::size_t first = 0; first + tenth <= costs.size(); first += tenth / 2) {
                const double part =
                    std::accumulate(costs.begin() + static_cast<long>(first),
                                    costs.begin() + static_cast<long>(first + tenth), 0.0);
                EXPECT_NEAR(
                    part / static_cast<double>(tenth) / (all / static_cast<double>(costs.size())),
                    1, 0.2)
                    << name << " " << width << " from " << first;
            }
        }
}

TEST(PictureTiles, ShareOutEveryPixelOnce) {
    constexpr Film::Window picture{3, 5, 61, 40};
    for (const int count : {1, 2, 3, 4, 7, 12, 35}) {
        std::vector<int> covered(61 * 40);
        int least = 61 * 40, most = 0;
        for (int i = 0; i < count; ++i) {
            const Film::Window tile = render::pictureTile(picture, i, count);
            least = std::min(least, tile.width() * tile.height());
            most = std::max(most, tile.width() * tile.height());
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x)
                    ++covered[static_cast<std::size_t>(y * 61 + x)];
        }
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 61; ++x)
                EXPECT_EQ(covered[static_cast<std::size_t>(y * 61 + x)], x >= 3 && y >= 5);
        EXPECT_LE(most - least, 61 + 40) << count;
    }
}

TEST(PictureTiles, AreAsSquareAsTheyCan) {
    using Window = Film::Window;
    constexpr Window wide{0, 0, 1920, 1080};
    EXPECT_EQ(render::pictureTile(wide, 0, 4), (Window{0, 0, 960, 540}));
    EXPECT_EQ(render::pictureTile(wide, 1, 4), (Window{960, 0, 1920, 540}));
    EXPECT_EQ(render::pictureTile(wide, 5, 6), (Window{1280, 540, 1920, 1080}));
    EXPECT_EQ(render::pictureTile({0, 0, 100, 400}, 1, 4), (Window{0, 100, 100, 200}));
    expectError(ErrorKind::Usage, "7 tiles are too many for 4 x 4 pixels", [] {
        render::pictureTile({0, 0, 4, 4}, 0, 7);
    });
}

}  // namespace
}  // namespace woodcock::test
