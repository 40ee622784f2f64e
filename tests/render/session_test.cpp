// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/session.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/expect_error.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

/// Fog with a local light in it, a sun and a sky: everything that draws random numbers.
Scene fog(const char* sigma = "sigma_a = 0.1\nsigma_s = [1, 2, 0.5]\n") {
    return sceneFrom(std::string("[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n") +
                     sigma +
                     "g = 0.5\n"
                     "[[light]]\ntype = \"sun\"\ndirection = [1, -2, 0]\nangular_diameter = 5\n"
                     "[[light]]\ntype = \"point\"\nposition = [0.2, 0.3, 0.1]\n"
                     "[[light]]\ntype = \"sphere\"\nposition = [-0.5, 0.2, 0]\nradius = 0.1\n"
                     "[[light]]\ntype = \"environment\"\nradiance = 0.3\n"
                     "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 30\n");
}

RenderSettings settings(int width = 41, int height = 35, int samples = 8) {
    RenderSettings s;
    s.width = width, s.height = height, s.endSample = samples;
    s.layers.depth = true;
    return s;
}

/// All sums of a pixel, for comparison bit by bit.
std::vector<double> sums(const Film::Pixel& p) {
    std::vector<double> all{p.alpha,
                            p.weightedDepth,
                            p.depthWeight,
                            static_cast<double>(p.samples),
                            static_cast<double>(p.depthSamples),
                            static_cast<double>(p.nonFinite)};
    for (int c = 0; c < 3; ++c)
        all.insert(all.end(), {p.radiance[c], p.radianceSquared[c], p.transmittance[c]});
    return all;
}

/// Over the crop of `a`.
void expectSameBits(const Film& a, const Film& b) {
    const Film::Window crop = a.crop();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            ASSERT_EQ(sums(a.at(x, y)), sums(b.at(x, y))) << x << ", " << y;
}

TEST(Session, ThreadsDoNotShow) {
    const Scene scene = fog();
    RenderSettings s = settings();
    s.threads = 1;
    const RenderResult one = render::render(scene, s);
    EXPECT_EQ(one.reason, StopReason::Complete);
    EXPECT_EQ(one.endSample, 8);
    EXPECT_EQ(one.counters.paths, 41u * 35u * 8u);
    for (const int threads : {2, 3, 0}) {
        s.threads = threads;
        const RenderResult many = render::render(scene, s);
        expectSameBits(one.film, many.film);
        EXPECT_EQ(one.counters.distanceCollisions, many.counters.distanceCollisions);
    }
}

TEST(Session, CropsShowTheSamePixels) {
    const Scene scene = fog();
    RenderSettings s = settings();
    const RenderResult whole = render::render(scene, s);
    for (const Film::Window crop :
         {Film::Window{0, 0, 1, 1}, {13, 5, 40, 18}, {16, 16, 32, 32}, {40, 0, 41, 35}}) {
        s.crop = crop;
        const RenderResult part = render::render(scene, s);
        EXPECT_EQ(part.film.crop(), crop);
        expectSameBits(part.film, whole.film);
    }
}

TEST(Session, SampleRangesMerge) {
    const Scene scene = fog();
    RenderSettings s = settings(41, 35, 22);
    const RenderResult whole = render::render(scene, s);
    s.endSample = 9;
    RenderResult merged = render::render(scene, s);
    s.firstSample = 9, s.endSample = 22;
    merged.film.merge(render::render(scene, s).film);
    for (int y = 0; y < 35; ++y)
        for (int x = 0; x < 41; ++x) {
            EXPECT_EQ(merged.film.at(x, y).samples, 22u);
            for (int c = 0; c < 3; ++c) {
                EXPECT_FLOAT_EQ(merged.film.radiance(x, y)[c], whole.film.radiance(x, y)[c]);
                EXPECT_FLOAT_EQ(merged.film.transmittance(x, y)[c],
                                whole.film.transmittance(x, y)[c]);
            }
            EXPECT_FLOAT_EQ(merged.film.alpha(x, y), whole.film.alpha(x, y));
            EXPECT_FLOAT_EQ(merged.film.depth(x, y), whole.film.depth(x, y));
        }
}

/// Of three independent numbers alike, any is the middle one with probability 1/3.
TEST(Session, SeedsAreIndependent) {
    const Scene scene = fog();
    const auto picture = [&](std::uint64_t seed) {
        RenderSettings s = settings(48, 48, 16);
        s.seed = seed;
        s.crop = Film::Window{16, 16, 32, 32};  // all fog
        return render::render(scene, s).film;
    };
    const Film a = picture(1), b = picture(2), c = picture(1ull << 63);
    int middle = 0, same = 0;
    for (int y = 16; y < 32; ++y)
        for (int x = 16; x < 32; ++x) {
            const float u = a.radiance(x, y)[0], v = b.radiance(x, y)[0], w = c.radiance(x, y)[0];
            same += u == v || v == w || u == w;
            middle += (u < w) != (v < w);
        }
    EXPECT_EQ(same, 0);
    EXPECT_NEAR(middle / 256.0, 1.0 / 3, 4 * std::sqrt(2.0 / 9 / 256));
}

TEST(Session, NothingIsNotFinite) {
    for (const char* sigma :
         {"sigma_s = 1e12\n", "sigma_a = 1e12\nsigma_s = 1\n", "sigma_s = 1e-12\n",
          "sigma_a = 1e-12\n", "sigma_a = [1e4, 0, 1]\nsigma_s = [1, 1e-4, 0]\n",
          "sigma_s = [1e12, 1, 1e-12]\n", "sigma_a = [1e12, 1, 0]\nsigma_s = [1, 1e-12, 1]\n"}) {
        RenderSettings s = settings(16, 16, 4);
        s.maxScatterings = 100;
        const RenderResult result = render::render(fog(sigma), s);
        EXPECT_EQ(result.film.nonFiniteCount(), 0u) << sigma;
    }
}

TEST(Session, StopsAtTheTimeLimit) {
    RenderSettings s = settings(64, 64, 1 << 30);
    s.timeLimit = 0.2;
    RenderResult result = render::render(fog(), s);
    // A busy machine may need longer for the first sample.
    for (; result.endSample == 0; result = render::render(fog(), s)) s.timeLimit *= 4;
    EXPECT_EQ(result.reason, StopReason::TimeLimit);
    EXPECT_LT(result.endSample, 1 << 30);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            EXPECT_GE(result.film.at(x, y).samples, static_cast<std::uint64_t>(result.endSample));
}

/// Fog of albedo 1 that fills all space: hardly a path ends.
TEST(Session, StopsAtTheTimeLimitWhatHasNoEnd) {
    const Scene scene = proof::sceneFrom(
        "[[volume]]\nbox = { min = [-1e30, -1e30, -1e30], max = [1e30, 1e30, 1e30] }\n"
        "sigma_s = 1\nsigma_a = 0\n"
        "[[light]]\ntype = \"environment\"\n[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, 1]\n");
    RenderSettings s = settings(64, 64, 1);
    s.timeLimit = 0.2;
    const RenderResult result = render::render(scene, s);
    EXPECT_EQ(result.reason, StopReason::TimeLimit);
    EXPECT_EQ(result.endSample, 0);
    EXPECT_GT(result.film.pixelsWithoutSamples(), 0U);
    EXPECT_LT(result.seconds, 20);  // of 0.4: nothing that an end must be waited for
}

TEST(Session, StopsAtTheNoise) {
    RenderSettings s = settings(32, 32, 1 << 30);
    s.noise = 0.05;
    const RenderResult result = render::render(fog(), s);
    EXPECT_EQ(result.reason, StopReason::NoiseReached);
    EXPECT_LT(result.film.noise(), 0.05);
    EXPECT_GT(result.film.noise(), 0.02);  // and not long after it
    s.noise = 1e-9, s.endSample = 16;
    EXPECT_EQ(render::render(fog(), s).reason, StopReason::Complete);
}

/// What an interrupted render leaves is the beginning of the whole one, in every pixel.
TEST(Session, InterruptionKeepsWholeSamples) {
    const Scene scene = fog();
    RenderSettings s = settings(80, 64, 1 << 30);
    int calls = 0;
    const RenderResult stopped = render::render(
        scene, s, [&](const RenderProgress& p) { return ++calls < 3 || p.samples < 2; });
    EXPECT_EQ(stopped.reason, StopReason::Interrupted);
    ASSERT_GE(stopped.endSample, 2);
    // Tiles that were ready when the stop came may hold one pass more, all their pixels alike.
    std::map<std::uint64_t, std::vector<Film::Window>> tiles;
    for (int y = 0; y < 64; y += 16)
        for (int x = 0; x < 80; x += 16) {
            const std::uint64_t samples = stopped.film.at(x, y).samples;
            EXPECT_GE(samples, static_cast<std::uint64_t>(stopped.endSample));
            tiles[samples].push_back({x, y, x + 16, y + 16});
        }
    EXPECT_LE(tiles.size(), 2u);
    for (const auto& [samples, windows] : tiles) {
        s.crop = windows.front();
        s.endSample = static_cast<int>(samples);
        expectSameBits(render::render(scene, s).film, stopped.film);
        for (const Film::Window& w : windows)
            for (int y = w.y0; y < w.y1; ++y)
                for (int x = w.x0; x < w.x1; ++x) EXPECT_EQ(stopped.film.at(x, y).samples, samples);
    }
}

TEST(Session, TellsItsProgress) {
    std::vector<RenderProgress> told;
    RenderSettings s = settings(64, 64, 64);
    render::render(fog(), s, [&](const RenderProgress& p) { return told.push_back(p), true; });
    ASSERT_FALSE(told.empty());
    for (std::size_t i = 1; i < told.size(); ++i) {
        EXPECT_GE(told[i].fraction, told[i - 1].fraction);
        EXPECT_GE(told[i].samples, told[i - 1].samples);
    }
    EXPECT_EQ(told.back().fraction, 1);
    EXPECT_EQ(told.back().samples, 64);
    EXPECT_GT(told.back().noise, 0);
}

TEST(Session, RefusesWhatIsEmpty) {
    const Scene scene = fog();
    RenderSettings s = settings();
    s.width = 0;
    expectError(ErrorKind::Usage, "0 x 35", [&] { render::render(scene, s); });
    s = settings();
    s.firstSample = 8;
    expectError(ErrorKind::Usage, "8:8", [&] { render::render(scene, s); });
    s = settings();
    s.crop = Film::Window{10, 10, 42, 20};
    expectError(ErrorKind::Usage, "10,10,42,20", [&] { render::render(scene, s); });
}

}  // namespace
}  // namespace woodcock::test
