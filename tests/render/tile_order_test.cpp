// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/tile_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <set>

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

}  // namespace
}  // namespace woodcock::test
