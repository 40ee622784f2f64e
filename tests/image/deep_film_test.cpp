// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/deep_film.h"

#include <gtest/gtest.h>

#include <cmath>

namespace woodcock::test {

using namespace image;

namespace {

using Stop = StoppedLight::Stop;
using Kind = Stop::Kind;

/// What OpenEXR's and OpenImageIO's flattening make of samples: over, from front to back.
struct Flat {
    double colour = 0, alpha = 0;
};
Flat flatten(const std::vector<DeepSample>& samples) {
    Flat flat;
    for (const DeepSample& s : samples) {
        flat.colour += (1 - flat.alpha) * s.colour[0];
        flat.alpha += (1 - flat.alpha) * s.alpha;
    }
    return flat;
}

/// A film of one pixel, and deep pixels of the same samples.
struct Pixel {
    Film film;
    DeepFilm deep;
    explicit Pixel(std::vector<float> edges, double error = 0.01)
        : film(1, 1, {0, 0, 1, 1}, {true, false, false}), deep({0, 0, 1, 1}, error, {edges}) {}
    void add(const StoppedLight& ray) {
        FilmSample sample;
        for (const Stop& s : ray.stops)
            if (s.kind != Kind::ShadowCatcher) sample.alpha += static_cast<float>(s.amount());
        for (const auto& a : ray.arrivals) sample.radiance += a.radiance;
        film.add(0, 0, sample);
        deep.add(0, 0, ray);
    }
    std::vector<DeepSample> samples() const { return deep.samples(0, 0, film); }
    void expectFlattened() const {
        const Flat flat = flatten(samples());
        EXPECT_NEAR(flat.colour, film.radiance(0, 0)[0], 1e-6);
        EXPECT_NEAR(flat.alpha, film.alpha(0, 0), 1e-6);
    }
};

void expectTidy(const std::vector<DeepSample>& samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_GE(samples[i].alpha, 0);
        EXPECT_LE(samples[i].alpha, 1);
        EXPECT_LE(samples[i].near, samples[i].far);
        if (samples[i].far > samples[i].near) {
            EXPECT_LT(samples[i].alpha, 1);
        }
        if (i == 0) continue;
        EXPECT_GE(samples[i].near, samples[i - 1].far);
        if (samples[i - 1].far == samples[i - 1].near) {
            EXPECT_GT(samples[i].near, samples[i - 1].far);
        }
    }
}

TEST(DeepFilm, BinsHoldTransmittanceAndColourOverEachOther) {
    // T = 1, 0.5, 0.125 at depths 1, 2, 4; each bin sends light.
    Pixel pixel({1, 2, 4});
    pixel.add({.stops = {{.near = 1, .far = 2, .before = 1, .after = 0.5, .owner = 0},
                         {.near = 2, .far = 4, .before = 0.5, .after = 0.125, .owner = 0}},
               .arrivals = {{1.5, Rgb(3), false}, {3, Rgb(2), false}}});
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_FLOAT_EQ(samples[0].alpha, 0.5f);
    EXPECT_FLOAT_EQ(samples[1].alpha, 0.75f);
    EXPECT_FLOAT_EQ(samples[0].colour[0], 3);
    EXPECT_FLOAT_EQ(samples[1].colour[0], 4);  // L / T
    EXPECT_EQ(samples[1].near, 2);
    EXPECT_EQ(samples[1].far, 4);
    pixel.expectFlattened();
}

TEST(DeepFilm, PiecesFallExponentiallyOverSeveralBins) {
    Pixel pixel({0, 1, 3, 4});
    pixel.add({.stops = {{.near = 0, .far = 4, .before = 1, .after = std::exp(-2.0), .owner = 0}},
               .arrivals = {}});
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_NEAR(samples[0].alpha, 1 - std::exp(-0.5), 1e-6);
    EXPECT_NEAR(samples[1].alpha, 1 - std::exp(-1.0), 1e-6);
    EXPECT_NEAR(samples[2].alpha, 1 - std::exp(-0.5), 1e-6);
}

TEST(DeepFilm, APointInABinSplitsItAsTheFormatSays) {
    // The specification's example: [1, 3], alpha 0.75, colour 0.6, at 2: twice alpha 0.5, colour
    // 0.4. A second ray that meets a surface there is of no weight in this.
    Pixel pixel({1, 3});
    pixel.add({.stops = {{.near = 1, .far = 3, .before = 1, .after = 0.25, .owner = 0}},
               .arrivals = {{1.2, Rgb(0.6f), false}}});
    StoppedLight lamp;
    lamp.arrivals = {{2, Rgb(0.8f), true}};
    pixel.deep.add(0, 0, lamp);  // of the same ray
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 3u);
    EXPECT_FLOAT_EQ(samples[0].alpha, 0.5f);
    EXPECT_FLOAT_EQ(samples[0].colour[0], 0.4f);
    EXPECT_FLOAT_EQ(samples[1].alpha, 0);
    EXPECT_FLOAT_EQ(samples[1].colour[0], 1.6f);  // behind half of the light
    EXPECT_FLOAT_EQ(samples[2].alpha, 0.5f);
    EXPECT_FLOAT_EQ(samples[2].colour[0], 0.4f);
    expectTidy(samples);
}

TEST(DeepFilm, SurfacesOfOneDepthAreOnePoint) {
    Pixel pixel({});
    for (const double depth : {5.0, 5.01, 4.99, 7.0})
        pixel.add(
            {.stops = {{.near = depth,
                        .far = depth,
                        .before = 1,
                        .after = 0,
                        .owner = depth > 6 ? 4u : 3u,
                        .kind = Kind::Surface}},
             .arrivals = {{depth, Rgb(static_cast<float>(depth)), true, depth > 6 ? 4u : 3u}}});
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_FLOAT_EQ(samples[0].near, 5);
    EXPECT_FLOAT_EQ(samples[0].alpha, 0.75f);
    EXPECT_FLOAT_EQ(samples[0].colour[0], 3.75f);
    EXPECT_FLOAT_EQ(samples[1].alpha, 1);
    EXPECT_FLOAT_EQ(samples[1].colour[0], 7);
    pixel.expectFlattened();
}

TEST(DeepFilm, ManyDepthsStayFewPoints) {
    Pixel pixel({}, 0.001);
    for (int i = 0; i < 100; ++i)
        pixel.add({.stops = {{.near = 1.0 + i,
                              .far = 1.0 + i,
                              .before = 1,
                              .after = 0,
                              .owner = static_cast<std::uint32_t>(i),
                              .kind = Kind::Surface}},
                   .arrivals = {{1.0 + i, Rgb(1), true, static_cast<std::uint32_t>(i)}}});
    EXPECT_EQ(pixel.samples().size(), DeepFilm::mostPoints);
    expectTidy(pixel.samples());
    pixel.expectFlattened();
}

TEST(DeepFilm, WhatLetsNothingThroughStaysSplittable) {
    Pixel pixel({1, 2, 3});
    pixel.add({.stops = {{.near = 1.5, .far = 1.5, .before = 1, .after = 0, .owner = 0}},
               .arrivals = {{1.5, Rgb(1), false}, {2.5, Rgb(0.25f), false}}});
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 1u);  // nothing is in front of what follows
    EXPECT_LT(samples[0].alpha, 1);
    EXPECT_GT(samples[0].alpha, 0.9999999f);
    pixel.expectFlattened();
}

TEST(DeepFilm, ShadowsOnACatcherAreItsAlpha) {
    Pixel pixel({});
    const StoppedLight ray{.stops = {{.near = 3,
                                      .far = 3,
                                      .before = 1,
                                      .after = 0,
                                      .owner = 1,
                                      .kind = Kind::ShadowCatcher}},
                           .arrivals = {}};
    pixel.add(ray);
    pixel.film.add(0, 0, CatcherSample{.lit = 0.25f, .unlit = 1, .weight = 1});
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_FLOAT_EQ(samples[0].alpha, 0.75f);
    pixel.expectFlattened();
}

TEST(DeepFilm, StraysOfMediaBecomePoints) {
    Pixel pixel({1, 2});
    pixel.add({.stops = {{.near = 1.5, .far = 1.5, .before = 1, .after = 0, .owner = 0}},
               .arrivals = {}});
    pixel.add({.stops = {{.near = 9, .far = 9, .before = 1, .after = 0, .owner = 0}},
               .arrivals = {{9, Rgb(1), false}}});
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_EQ(samples[1].near, 9);
    EXPECT_FLOAT_EQ(samples[1].alpha, 1);
    pixel.expectFlattened();
}

// Single rays of coloured media may gain light on their way.
TEST(DeepFilm, LightThatGrowsIsOwedToWhatFollows) {
    Pixel pixel({1, 2, 3});
    pixel.add({.stops = {{.near = 1.5, .far = 1.5, .before = 1, .after = 1.25, .owner = 0},
                         {.near = 2.5, .far = 2.5, .before = 1.25, .after = 0.5, .owner = 0}},
               .arrivals = {}});
    const auto samples = pixel.samples();
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_FLOAT_EQ(samples[0].alpha, 0.5f);
    expectTidy(samples);
}

TEST(DeepFilm, EmptyPixelsHaveNoSamples) {
    Pixel pixel({});
    EXPECT_TRUE(pixel.samples().empty());
    pixel.add({});
    EXPECT_TRUE(pixel.samples().empty());
}

TEST(DeepFilm, CannotBeCrackedByRandomRays) {
    std::uint32_t state = 1;
    const auto random = [&] {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) / double{1 << 24};
    };
    for (int pixels = 0; pixels < 200; ++pixels) {
        Pixel pixel({1, 1.5f, 2, 4, 4.5f});
        for (int rays = 0; rays < 8; ++rays) {
            StoppedLight ray;
            double left = 1, depth = 0.9;
            while (depth < 5 && left > 0) {
                const double far = random() < 0.5 ? depth : depth + random();
                const bool solid = random() < 0.2;
                const double after = solid ? 0 : left * random();
                ray.stops.push_back({.near = depth,
                                     .far = solid ? depth : far,
                                     .before = left,
                                     .after = after,
                                     .owner = solid ? 7u : 0u,
                                     .kind = solid ? Kind::Surface : Kind::Medium});
                ray.arrivals.push_back({depth, Rgb(static_cast<float>(random())), solid, 7});
                left = after, depth = far + random();
            }
            pixel.add(ray);
        }
        expectTidy(pixel.samples());
        pixel.expectFlattened();
    }
}

/// Parts add up to the film of all rays, also where pixels of several windows come together.
TEST(DeepFilm, PartsAreOneFilm) {
    const std::vector<float> edges{1, 2, 4};
    const auto ray = [](double after, double depth) {
        return StoppedLight{
            .stops = {{.near = 1, .far = 4, .before = 1, .after = after, .owner = 0},
                      {.near = depth,
                       .far = depth,
                       .before = after,
                       .after = 0,
                       .owner = 3,
                       .kind = Kind::Surface}},
            .arrivals = {{1.5, Rgb(3), false}, {depth, Rgb(2), true, 3}}};
    };
    using Edges = std::vector<std::vector<float>>;
    DeepFilm whole({0, 0, 2, 1}, 0.01, Edges{edges, {}}), left({0, 0, 1, 1}, 0.01, Edges{edges}),
        right({1, 0, 2, 1}, 0.01, Edges(1)), both({0, 0, 2, 1}, 0.01, Edges{edges, {}});
    Film film(2, 1, {0, 0, 2, 1});
    for (const auto& [x, after, depth] : {std::tuple(0, 0.5, 5.0),
                                          {0, 0.25, 7.0},
                                          {1, 0.75, 5.0},
                                          {0, 0.75, 5.01},
                                          {1, 0.5, 6.0}}) {
        whole.add(x, 0, ray(after, depth));
        film.add(x, 0, FilmSample{Rgb(5), 1});
        DeepFilm& part = depth > 5 ? both : x == 0 ? left : right;
        part.add(x, 0, ray(after, depth));
    }
    EXPECT_FALSE(left.mismatch(right) || left.mismatch(both) || both.mismatch(right));
    const std::vector<DeepFilm> parts{right, left, both};
    const DeepFilm joined({0, 0, 2, 1}, parts);
    for (const int x : {0, 1}) {
        const auto a = whole.samples(x, 0, film), b = joined.samples(x, 0, film);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_FLOAT_EQ(a[i].near, b[i].near);
            EXPECT_FLOAT_EQ(a[i].far, b[i].far);
            EXPECT_FLOAT_EQ(a[i].alpha, b[i].alpha);
            EXPECT_FLOAT_EQ(a[i].colour[0], b[i].colour[0]);
        }
    }
    const DeepFilm other({1, 0, 2, 1}, 0.01, Edges{edges});
    EXPECT_EQ(whole.mismatch(other), (std::array{1, 0}));
}

}  // namespace

}  // namespace woodcock::test
