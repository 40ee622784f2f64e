// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

#include "woodcock/base/error.h"

namespace woodcock::test {

using namespace image;

namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Film smallFilm() { return Film(4, 3, {0, 0, 4, 3}); }

TEST(Film, MeansAndStandardErrorOfAFewSamples) {
    Film film = smallFilm();
    for (float v : {1.0f, 2.0f, 3.0f, 6.0f}) film.add(2, 1, FilmSample{Rgb(v, 2 * v, 5), v / 8});
    EXPECT_EQ(film.radiance(2, 1), Rgb(3, 6, 5));
    EXPECT_EQ(film.alpha(2, 1), 0.375f);
    // Squares of the deviations: 4 + 1 + 0 + 9; variance 14/3; of the mean 14/12.
    EXPECT_FLOAT_EQ(film.standardError(2, 1)[0], std::sqrt(14.0f / 12));
    EXPECT_FLOAT_EQ(film.standardError(2, 1)[1], 2 * std::sqrt(14.0f / 12));
    EXPECT_EQ(film.standardError(2, 1)[2], 0.0f);
    EXPECT_EQ(film.at(2, 1).samples, 4u);
    EXPECT_EQ(film.radiance(1, 1), Rgb(0.0f));
}

/// Where a pixel missed what its neighbours found, they know better.
TEST(Film, ErrorIsNoLessThanThatAround) {
    Film film = smallFilm();
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (int i = 0; i < 4; ++i)  // a variance of 4 in the two bright ones
                film.add(x, y, FilmSample{Rgb(i == 0 && x == 0 && y < 2 ? 4.0f : 0.0f), 1});
    EXPECT_FLOAT_EQ(film.standardError(0, 0)[0], 1);                        // its own
    EXPECT_FLOAT_EQ(film.standardError(0, 2)[0], std::sqrt(4.0f / 4 / 4));  // 1 of 4 is bright
    EXPECT_FLOAT_EQ(film.standardError(1, 1)[0], std::sqrt(8.0f / 9 / 4));  // 2 of 9
    EXPECT_FLOAT_EQ(film.variance(1, 1)[0], 8.0f / 9 / 4);
    EXPECT_EQ(film.standardError(2, 1), Rgb(0.0f));
    // Pixels with more samples have the smaller error, by the same variance of one.
    for (int i = 0; i < 12; ++i) film.add(1, 1, FilmSample{Rgb(0.0f), 1});
    EXPECT_FLOAT_EQ(film.standardError(1, 1)[0], std::sqrt(8.0f / 9 / 16));
}

TEST(Film, FeaturesAreMeansOverRays) {
    Film film(2, 1, {0, 0, 2, 1}, {.surfaces = false, .features = true}), other = film;
    film.add(0, 0, DepthSample{Rgb(0.0f), 1, 1, Rgb(0.5f, 1.5f, 1), {0, 0, 1}});
    film.add(0, 0, DepthSample{Rgb(1.0f), 0, 0});
    EXPECT_EQ(film.albedo(0, 0), Rgb(0.25f, 0.75f, 0.5f));
    EXPECT_EQ(film.normal(0, 0), (Vec3f{0, 0, 0.5f}));
    EXPECT_EQ(film.albedo(1, 0), Rgb(0.0f));
    other.add(0, 0, DepthSample{Rgb(0.0f), 1, 1, Rgb(1, 3, 1), {0, 1, 0}});
    other.add(0, 0, DepthSample{Rgb(0.0f), 1, 1, Rgb(1, 3, 1), {0, 1, 0}});
    film.merge(other);
    EXPECT_EQ(film.albedo(0, 0), Rgb(0.625f, 1, 0.75f));  // never above 1
    EXPECT_EQ(film.normal(0, 0), (Vec3f{0, 0.5f, 0.25f}));
    EXPECT_EQ(smallFilm().normal(0, 0), (Vec3f{}));
}

TEST(Film, NothingIsNaNWithoutSamples) {
    Film film = smallFilm();
    film.add(0, 0, FilmSample{Rgb(1.0f), 1});
    for (int x : {0, 1}) {
        EXPECT_TRUE(film.radiance(x, 0).isFinite());
        EXPECT_EQ(film.standardError(x, 0), Rgb(inf));  // one sample says nothing of its error
        EXPECT_TRUE(film.transmittance(x, 0).isFinite());
        EXPECT_EQ(film.depth(x, 0), Film::noDepth);
    }
    EXPECT_EQ(film.noise(), double{inf});
}

TEST(Film, EqualSamplesHaveNoErrorWhateverTheirRounding) {
    Film film = smallFilm();
    for (int i = 0; i < 1000; ++i) film.add(0, 0, FilmSample{Rgb(0.1f, 1e-20f, 3e18f), 1});
    const Rgb error = film.standardError(0, 0);
    EXPECT_TRUE(error.isFinite());
    EXPECT_LT(error[0], 1e-8f * 0.1f);
    EXPECT_LT(error[1], 1e-8f * 1e-20f);
    EXPECT_LT(error[2], 1e-8f * 3e18f);
}

TEST(Film, SamplesThatAreNotFiniteAreCountedAndDropped) {
    Film film = smallFilm();
    film.add(1, 2, FilmSample{Rgb(1, 2, 3), 0.5f});
    film.add(1, 2, FilmSample{Rgb(1, nan, 3), 0.5f});
    film.add(1, 2, FilmSample{Rgb(1, 2, -inf), 0.5f});
    film.add(1, 2, FilmSample{Rgb(1, 2, 3), nan});
    film.add(1, 2, DepthSample{Rgb(0.5f), 3, 0.5f});
    film.add(1, 2, DepthSample{Rgb(0.5f), inf, 0.5f});
    film.add(3, 0, DepthSample{Rgb(nan), 1, 0.5f});
    EXPECT_EQ(film.nonFiniteCount(), 5u);
    EXPECT_EQ(film.at(1, 2).samples, 1u);
    EXPECT_EQ(film.radiance(1, 2), Rgb(1, 2, 3));
    EXPECT_EQ(film.transmittance(1, 2), Rgb(0.5f));
    EXPECT_EQ(film.depth(1, 2), 6.0f);
}

TEST(Film, DepthIsWeightedByWhatTheRayMeets) {
    Film film = smallFilm();
    film.add(0, 0, DepthSample{Rgb(0.25f), 0.75f * 10, 0.75f});
    film.add(0, 0, DepthSample{Rgb(0.75f), 0.25f * 30, 0.25f});
    film.add(0, 0, DepthSample{Rgb(1.0f), 0, 0});
    EXPECT_FLOAT_EQ(film.depth(0, 0), 15.0f);
    EXPECT_FLOAT_EQ(film.transmittance(0, 0)[0], 2.0f / 3);
}

TEST(Film, MergedHalvesEqualTheWholeToAFloatsLastPlace) {
    const Film::Window crop{2, 1, 7, 5};
    Film whole(9, 6, crop), first(9, 6, crop), second(9, 6, crop);
    std::mt19937 random(7);
    std::lognormal_distribution<float> light(0, 4);  // over many magnitudes, as fireflies are
    for (int sample = 0; sample < 64; ++sample)
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x) {
                const FilmSample s{Rgb(light(random), light(random), light(random)),
                                   std::generate_canonical<float, 24>(random)};
                const DepthSample d{s.radiance, light(random), s.alpha};
                Film& half = sample < 32 ? first : second;
                whole.add(x, y, s), half.add(x, y, s);
                whole.add(x, y, d), half.add(x, y, d);
            }
    first.merge(second);
    const auto near = [](Rgb a, Rgb b) {
        for (int i = 0; i < 3; ++i)
            if (a[i] < std::nextafter(b[i], -inf) || a[i] > std::nextafter(b[i], inf)) return false;
        return true;
    };
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            EXPECT_TRUE(near(first.radiance(x, y), whole.radiance(x, y)));
            EXPECT_TRUE(near(first.standardError(x, y), whole.standardError(x, y)));
            EXPECT_TRUE(near(first.transmittance(x, y), whole.transmittance(x, y)));
            EXPECT_TRUE(near(Rgb(first.alpha(x, y)), Rgb(whole.alpha(x, y))));
            EXPECT_TRUE(near(Rgb(first.depth(x, y)), Rgb(whole.depth(x, y))));
            EXPECT_EQ(first.at(x, y).samples, 64u);
        }
}

TEST(Film, NoiseIsTheErrorRelativeToTheMeanAround) {
    Film film(1, 1, {0, 0, 1, 1});
    // Mean 2, standard error 1; a tenth of the mean is added in squares.
    for (float v : {1.0f, 3.0f}) film.add(0, 0, FilmSample{Rgb(v), 1});
    EXPECT_DOUBLE_EQ(film.noise(), 1 / std::hypot(2.0, 0.2));
    // Two pixels' mean is 2, and the second has no error: root mean square.
    Film two(2, 1, {0, 0, 2, 1});
    for (float v : {1.0f, 3.0f}) two.add(0, 0, FilmSample{Rgb(v), 1});
    for (float v : {2.0f, 2.0f}) two.add(1, 0, FilmSample{Rgb(v), 1});
    EXPECT_NEAR(two.noise(), film.noise() / std::sqrt(2.0), 1e-7);
}

TEST(Film, NoiseOfThinThingsIsRelativeToWhatMayStandBehind) {
    // Half of the rays meet a medium of radiance 2: a mean of 1, before as much of the background.
    Film film(1, 1, {0, 0, 1, 1});
    film.add(0, 0, FilmSample{Rgb(2.0f), 1}), film.add(0, 0, FilmSample{Rgb(0.0f), 0});
    EXPECT_DOUBLE_EQ(film.noise(), 1 / std::hypot(2.0, 0.2));
}

/// Smoke of 6 x 6 pixels, noisy, in the middle of `size` x `size` ones of sky.
double noiseOfSmoke(int size, bool visibleSky, float sky = 4) {
    std::mt19937 random(11);
    Film film(size, size, {0, 0, size, size}, {false, false, visibleSky});
    const int first = size / 2 - 3;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (int i = 0; i < 16; ++i) {
                const bool smoke = x >= first && x < first + 6 && y >= first && y < first + 6;
                if (smoke && random() % 4 != 0)
                    film.add(x, y, FilmSample{Rgb(static_cast<float>(random() % 8)), 1, 1});
                else if (visibleSky)
                    film.add(x, y, FilmSample{Rgb(sky), 0, 0, Rgb(sky)});
                else
                    film.add(x, y, FilmSample{});
            }
    return film.noise();
}

TEST(Film, NoiseHasNothingToDoWithTheBackground) {
    const double noise = noiseOfSmoke(10, true);
    EXPECT_GT(noise, 0.1);
    EXPECT_LT(noise, 0.3);
    EXPECT_DOUBLE_EQ(noiseOfSmoke(10, false), noise);
    EXPECT_DOUBLE_EQ(noiseOfSmoke(10, true, 4000), noise);
    EXPECT_DOUBLE_EQ(noiseOfSmoke(40, true), noise);
    EXPECT_DOUBLE_EQ(noiseOfSmoke(40, false), noise);
}

TEST(Film, NoiseOfFireThatCoversNothing) {
    Film film(12, 12, {0, 0, 12, 12});
    for (float v : {1.0f, 3.0f})
        for (int x = 0; x < 3; ++x)
            for (int y = 0; y < 3; ++y) film.add(x, y, FilmSample{Rgb(v), 0, 0, {}, 1});
    for (int i = 0; i < 2; ++i)
        for (int x = 4; x < 12; ++x)
            for (int y = 4; y < 12; ++y) film.add(x, y, FilmSample{});
    // In the middle and at the edges towards nothing, where less is around.
    EXPECT_GT(film.noise(), 0.49);
    EXPECT_LT(film.noise(), 0.6);
}

TEST(Film, NoiseOfWhatOnlyAbsorbsIsThatOfAlpha) {
    Film film(2, 1, {0, 0, 2, 1}, {false, false, true});
    for (float alpha : {0.25f, 0.75f}) {
        film.add(0, 0, FilmSample{Rgb(1 - alpha), alpha, 0, Rgb(1 - alpha)});
        film.add(1, 0, FilmSample{Rgb(1.0f), 0, 0, Rgb(1.0f)});
    }
    EXPECT_DOUBLE_EQ(film.noise(), 0.25);
}

TEST(Film, NoiseOfNothingIsNoneAndOfDarknessUnknown) {
    Film film = smallFilm();
    for (int i = 0; i < 2; ++i) film.add(0, 0, FilmSample{});
    EXPECT_EQ(film.noise(), 0);
    // Paths scattered there and found no light yet.
    for (int i = 0; i < 2; ++i) film.add(1, 0, FilmSample{Rgb(0.0f), 1, 3});
    EXPECT_EQ(film.noise(), double{inf});
    film.add(1, 0, FilmSample{Rgb(9.0f), 1, 3});
    EXPECT_LT(film.noise(), 2);
}

TEST(Film, NoiseFallsWithTheRootOfTheSamples) {
    std::mt19937 random(3);
    std::exponential_distribution<float> light(1);
    const auto noiseOf = [&](int samples) {
        Film film(16, 16, {0, 0, 16, 16});
        for (int i = 0; i < samples; ++i)
            for (int p = 0; p < 256; ++p)
                film.add(p % 16, p / 16, FilmSample{Rgb(light(random)), 1});
        return film.noise();
    };
    // An exponential variate's deviation is its mean: 1 / sqrt(n); 256 pixels tell it to a percent.
    EXPECT_NEAR(noiseOf(400) * 20, 1, 0.02);
    EXPECT_NEAR(noiseOf(1600) * 40, 1, 0.02);
}

/// What samples add to is in a plane, all of it, and once.
TEST(Film, PlanesListEverySum) {
    for (const Film::Kept& kept : {Film::Kept{false, false, false}, Film::Kept{true, false, true},
                                   Film::Kept{true, true, true},
                                   Film::Kept{.surfaces = false,
                                   .features = false,
                                   .places = true,
                                   .stops = true,
                                   .parts = {.kinds = true, .groups = {"key"}}}}) {
        const Film film(5, 4, {1, 1, 4, 3}, kept);
        std::set<std::string> names;
        std::set<const void*> places;
        for (const Film::ConstPlane& plane : film.planes()) {
            EXPECT_TRUE(names.insert(plane.name).second) << plane.name;
            EXPECT_NE(plane.sums == nullptr, plane.counts == nullptr) << plane.name;
            for (std::size_t p = 0; p < film.pixelCount(); ++p)
                for (std::size_t c = 0; c < static_cast<std::size_t>(plane.components); ++c) {
                    const std::size_t i = p * plane.stride + c;
                    places.insert(plane.sums ? static_cast<const void*>(plane.sums + i)
                                             : plane.counts + i);
                }
        }
        EXPECT_EQ(film.pixelCount(), 6u);
        EXPECT_EQ(places.size() * sizeof(double), film.pixelCount() * Film::bytesPerPixel(kept));
    }
}

TEST(Film, SplitsLightIntoPartsOfTheSamplesThatCount) {
    Film film(2, 1, {0, 0, 2, 1},
              {.surfaces = false, .features = false, .parts = {.kinds = true, .groups = {"key"}}});
    std::vector<Rgb> parts(8);
    parts[static_cast<std::size_t>(LightKind::Emission)] = Rgb(1, 2, 3);
    parts[static_cast<std::size_t>(LightKind::Background)] = Rgb(1, 0, 0);
    parts[6] = Rgb(0.5f, 1, 0), parts[7] = Rgb(1.5f, 1, 3);
    film.add(1, 0, FilmSample{Rgb(2, 2, 3), 1}, parts);
    film.add(1, 0, FilmSample{Rgb(0.0f), 0}, std::vector<Rgb>(8));
    film.add(1, 0, FilmSample{Rgb(std::nanf("")), 0}, parts);
    EXPECT_EQ(film.light(LightKind::Emission, 1, 0), Rgb(0.5f, 1, 1.5f));
    EXPECT_EQ(film.light(LightKind::Background, 1, 0), Rgb(0.5f, 0, 0));
    EXPECT_EQ(film.light(LightKind::VolumeDirect, 1, 0), Rgb(0.0f));
    EXPECT_EQ(film.lightOfGroup(0, 1, 0), Rgb(0.25f, 0.5f, 0));
    EXPECT_EQ(film.lightOfGroup(1, 1, 0), Rgb(0.75f, 0.5f, 1.5f));
    EXPECT_EQ(film.light(LightKind::Emission, 0, 0), Rgb(0.0f));
    Film both = film;
    both.merge(film);
    EXPECT_EQ(both.lightOfGroup(1, 1, 0), film.lightOfGroup(1, 1, 0));
    EXPECT_EQ(both.at(1, 0).samples, 4u);
}

TEST(Film, PlanesAreTheFilmsOwnNumbers) {
    Film film(3, 2, {1, 0, 3, 2});
    film.add(2, 1, FilmSample{Rgb(1, 2, 3), 0.5f});
    const std::vector<Film::Plane> planes = film.planes();
    const auto named = [&](const char* name) {
        return *std::find_if(planes.begin(), planes.end(),
                             [&](const Film::Plane& plane) { return plane.name == name; });
    };
    const Film::Plane radiance = named("radiance"), samples = named("samples");
    ASSERT_EQ(radiance.components, 3);
    EXPECT_EQ(radiance.sums[3 * radiance.stride + 2], 3.0);
    EXPECT_EQ(samples.counts[3 * samples.stride], 1u);
    samples.counts[3 * samples.stride] = 2;
    EXPECT_EQ(film.radiance(2, 1), Rgb(0.5f, 1, 1.5f));
}

TEST(Film, RefusesEmptyImagesAndCropsOutside) {
    EXPECT_THROW(Film(0, 3, {0, 0, 0, 3}), Error);
    EXPECT_THROW(Film(4, 3, {1, 1, 1, 2}), Error);
    EXPECT_THROW(Film(4, 3, {0, 0, 5, 3}), Error);
    EXPECT_THROW(Film(4, 3, {-1, 0, 4, 3}), Error);
    Film film = smallFilm();
    EXPECT_THROW(film.merge(Film(4, 3, {0, 0, 4, 2})), Error);
    EXPECT_THROW(film.merge(Film(4, 3, {0, 0, 4, 3}, {.surfaces = false, .features = true})),
                 Error);
}

}  // namespace
}  // namespace woodcock::test
