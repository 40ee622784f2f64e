// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/deep_state.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/expect_error.h"
#include "tests/support/same_films.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/image/write_exr.h"

namespace woodcock::test {

using namespace image;

namespace {

using Stop = StoppedLight::Stop;

constexpr Film::Window crop{3, 2, 14, 9};
constexpr std::size_t pixels = 11 * 7;

/// Bins and points of all numbers that pixels may have, also none.
DeepFilm randomFilm(int seed, bool bins = true, bool points = true) {
    std::vector<std::vector<float>> edges(pixels);
    std::mt19937 random(9);  // the same edges for all
    if (bins)
        for (std::vector<float>& pixel : edges)
            if (const std::size_t count = random() % 7; count > 1)
                for (std::size_t i = 0; i < count; ++i)
                    pixel.push_back(static_cast<float>(i + 1) + 0.25f);
    DeepFilm film(crop, 0.01, edges);
    random.seed(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> unit(0, 1);
    const auto depth = [&] { return 0.5 + 8 * unit(random); };
    for (int i = 0; i < 400; ++i) {
        const int x = crop.x0 + i % 11, y = crop.y0 + i / 11 % 7;
        StoppedLight ray;
        if (bins)
            ray.stops.push_back(
                {.near = 1.5, .far = 2 + depth(), .before = 1, .after = unit(random), .owner = 0});
        if (points) {
            const double at = depth();
            ray.stops.push_back({.near = at,
                                 .far = at,
                                 .before = 0.5,
                                 .after = unit(random),
                                 .owner = 3,
                                 .kind = Stop::Kind::ShadowCatcher});
            ray.arrivals.push_back({at, Rgb(static_cast<float>(unit(random))), true, 3});
        }
        film.add(x, y, ray);
    }
    return film;
}

class DeepStates : public testing::Test {
protected:
    std::filesystem::path write(const DeepFilm& film, StateFacts facts = {}) const {
        const DeepState state(film);
        facts.merge(state.facts());
        const FilmState all{facts, 20, 10, crop, state.planes()};
        const Film flat(20, 10, crop);
        writeExr(dir / "a.exr", flat, {}, {}, &all);
        return dir / "a.exr";
    }
    static DeepFilm read(const std::filesystem::path& path) {
        const StateFile file(path, "checkpoint");
        DeepState state(file);
        file.read(state.planes());
        return state.film(file);
    }
    const TempDir dir;
};

TEST_F(DeepStates, ComeBackToTheLastBit) {
    for (const auto& [bins, points] :
         {std::pair(true, true), {true, false}, {false, true}, {false, false}}) {
        const DeepFilm film = randomFilm(1, bins, points);
        DeepFilm back = read(write(film));
        expectSameBits(film, back);
        EXPECT_EQ(film.error(), back.error());
        // It goes on like the other.
        DeepFilm once = film;
        once.add(randomFilm(2, bins, points));
        back.add(randomFilm(2, bins, points));
        expectSameBits(once, back);
    }
}

TEST_F(DeepStates, NumbersOfNoFilmAreRefused) {
    const DeepFilm film = randomFilm(1);
    const auto refuse = [&](const StateFacts& facts, const char* said) {
        expectError(ErrorKind::Input, said, [&] { read(write(film, facts)); });
    };
    refuse({{"deepError", "-1"}}, "its deep pixels make no sense");
    refuse({{"deepEdges", "-1"}}, "its 'deepEdges' is '-1', not a number from 0 to 80740352");
    refuse({{"deepPoints", "1"}}, "its sums are not those that were written");
    refuse({{"deepEdges", "7000"}}, "its sums are not those that were written");

    const auto refuseSums = [&](auto change) {
        DeepSums sums = film.sums();
        change(sums);
        expectError(ErrorKind::Input, "its deep pixels make no sense",
                    [&] { read(write(DeepFilm(crop, 0.01, std::move(sums)))); });
    };
    constexpr float infinite = std::numeric_limits<float>::infinity();
    refuseSums([](DeepSums& s) { s.edges[1] = 0; });
    refuseSums([](DeepSums& s) { s.edges[0] = -1; });
    refuseSums([](DeepSums& s) { s.edges.back() = infinite; });
    refuseSums([](DeepSums& s) { s.points[0].resize(9, s.points[0].front()); });
    refuseSums([](DeepSums& s) { s.points[0][0].hits = 0; });
    refuseSums([](DeepSums& s) { s.points[0][0].depths = infinite; });
    // An edge alone bounds nothing.
    refuseSums([](DeepSums& s) {
        for (std::size_t i = 1; i < s.firstEdge.size(); ++i)
            if (s.firstEdge[i] == s.firstEdge[i - 1]) {
                ++s.firstEdge[i];
                break;
            }
    });
}

}  // namespace
}  // namespace woodcock::test
