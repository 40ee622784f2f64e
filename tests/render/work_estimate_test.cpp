// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/work_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "woodcock/render/tile_order.h"

namespace woodcock::test {

using namespace image;
using namespace render;

namespace {

using Costs = std::function<double(int x, int y)>;  // of a path in a tile
constexpr int size = 1280, tileSize = 16;

/// Time of the whole over what the estimate says of it once `part` of it is over, in a render by
/// one thread that takes passes of 1, 2, 4, ..., 32 samples.
struct Told {
    double part, ratio;
};
std::vector<Told> simulate(const Costs& cost, int samples, bool scattered) {
    std::vector<Film::Window> tiles = scatteredTiles({0, 0, size, size}, tileSize);
    if (!scattered)
        std::sort(tiles.begin(), tiles.end(), [](const Film::Window& a, const Film::Window& b) {
            return std::pair(a.y0, a.x0) < std::pair(b.y0, b.x0);
        });
    WorkEstimate estimate(tiles.size(), samples);
    double clock = 0;
    std::vector<std::pair<double, double>> told;  // time, fraction
    for (int done = 0, length = 1; done < samples;
         done += length, length = std::min(2 * length, 32)) {
        length = std::min(length, samples - done);
        const auto paths = static_cast<std::size_t>(tileSize * tileSize * length);
        estimate.begin(length, std::vector<std::size_t>(tiles.size(), paths));
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const double seconds = static_cast<double>(paths) * cost(tiles[i].x0, tiles[i].y0);
            clock += seconds;
            estimate.finish(i, seconds);
            told.emplace_back(clock, estimate.fraction());
        }
        estimate.end();
    }
    EXPECT_DOUBLE_EQ(estimate.fraction(), 1);
    std::vector<Told> ratios;
    for (const auto& [time, fraction] : told)
        ratios.push_back({time / clock, time / fraction / clock});
    return ratios;
}

/// The largest deviation of the ratio from 1 after a tenth of the time.
double worstAfterATenth(const std::vector<Told>& told) {
    double worst = 0;
    for (const Told& t : told)
        if (t.part >= 0.1) worst = std::max(worst, std::abs(t.ratio - 1));
    return worst;
}

TEST(WorkEstimate, IsHonestFromATenthOnWhateverThePicture) {
    const std::vector<std::pair<const char*, Costs>> pictures{
        {"even", [](int, int) { return 1.0; }},
        {"sky on top", [](int, int y) { return y < 800 ? 1.0 : 50.0; }},
        {"sky below", [](int, int y) { return y > 400 ? 1.0 : 50.0; }},
        {"smoke", [](int x, int y) { return std::hypot(x - 800, y - 480) < 240 ? 80.0 : 1.0; }},
        {"a column", [](int x, int) { return x > 800 && x < 960 ? 50.0 : 1.0; }}};
    for (const auto& [name, cost] : pictures)
        for (const int samples : {1, 2, 8, 64, 100, 1000}) {
            EXPECT_LT(worstAfterATenth(simulate(cost, samples, true)), 0.2) << name << samples;
            if (samples >= 64) {
                EXPECT_LT(worstAfterATenth(simulate(cost, samples, true)), 0.02) << name << samples;
            }
        }
    // The test would see rows from the top.
    EXPECT_GT(worstAfterATenth(simulate(pictures[1].second, 1, false)), 0.5);
}

TEST(WorkEstimate, CountsTilesByWhatTheyCostBefore) {
    WorkEstimate estimate(2, 4);
    estimate.begin(1, {10, 10});
    EXPECT_EQ(estimate.fraction(), 0);
    estimate.finish(0, 1);
    EXPECT_DOUBLE_EQ(estimate.fraction(), 0.5 / 4);
    estimate.finish(1, 9);
    estimate.end();
    EXPECT_DOUBLE_EQ(estimate.fraction(), 0.25);
    estimate.begin(3, {60, 20});  // 6 and 18 seconds are expected
    estimate.finish(0, 6);
    EXPECT_DOUBLE_EQ(estimate.samplesDone(), 1 + 3 * 0.25);
}

}  // namespace
}  // namespace woodcock::test
