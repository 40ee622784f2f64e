// SPDX-License-Identifier: Apache-2.0
// What pictures of paths in lanes have beside their mean radiance, which `verify` proves.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string_view>

#include "tests/render/lanes/lane_subjects.h"
#include "tests/support/expect_estimate.h"
#include "tests/support/same_films.h"
#include "woodcock/proof/support/small_pictures.h"
#include "woodcock/render/lanes/lane_scene.h"
#include "woodcock/render/lanes/trace_lanes.h"
#include "woodcock/render/stages/retire.h"
#include "woodcock/render/stages/shadow_walk.h"
#include "woodcock/render/stages/spawn.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

class Lanes : public testing::Test {
protected:
    LaneSubjects subjects;
    using S = LaneSubjects;
};

/// Nothing is lost, so every path brings the radiance that is everywhere, whatever splits it, ends
/// it or follows it several times. Of a sun so weak that it brings nothing, paths are still kept
/// dense near it.
TEST_F(Lanes, EveryPathInAFurnaceBringsTheSame) {
    const std::string furnace = "[[light]]\ntype = \"environment\"\nradiance = 0.5\n";
    for (const char* medium :
         {"sigma_s = 60\nsigma_a = 0\ng = 0.85\n", "sigma_s = 40\nsigma_a = 0\n",
          "sigma_s = 2\nsigma_a = 0\ng = -0.3\n"})
        for (const bool sun : {false, true}) {
            SCOPED_TRACE(testing::Message() << medium << (sun ? "with a sun" : ""));
            const Scene scene =
                subjects.scene(S::ball(medium) + (sun ? S::sun(1e-15) : "") + furnace);
            const LightDepths depths(scene, {}, ApproximateMedia(scene, {}));
            PathTracer::Options options;
            options.width = options.height = 10, options.lightDepths = &depths;
            const auto cameraDepths = CameraDepths::make(scene, options.width, options.height);
            options.cameraDepths = cameraDepths.get();
            const auto radiance = RadianceLattice::make(scene);
            options.radiance = radiance.get();
            const TracedScene traced(scene, findNeeds(scene), options);
            const auto lanes = LaneScene::make(traced);
            ASSERT_TRUE(lanes);
            EXPECT_EQ(lanes->sunDepths[0] != nullptr, sun);
            double events = 0;
            for (const PathResult& path : trace(scene, options, jobsOf(10, 8))) {
                // Roundings of the weights add up along a path.
                ASSERT_NEAR(path.film.radiance[0], 0.5, 2e-5) << path.film.events;
                events += double{path.film.events};
            }
            EXPECT_GT(events, 0);
        }
}

/// A flight may come to a face just when it has used up its optical depth. Here all begin so, most
/// of them in empty cells, where nothing is to collide.
TEST_F(Lanes, NothingCollidesInEmptyCells) {
    for (const char* medium :
         {"sigma_s = 60\nsigma_a = 0\n", "sigma_s = [60, 40, 30]\nsigma_a = 0\n"}) {
        const Scene scene =
            subjects.scene(S::ball(medium) + "[[light]]\ntype = \"environment\"\nradiance = 0.5\n");
        PathTracer::Options options;
        options.width = options.height = 10;
        const TracedScene traced(scene, findNeeds(scene), options);
        const auto expectAll = [&]<int N>(Batch<N, false> batch) {
            const std::vector<PathJob> jobs = jobsOf(10, 4);
            std::vector<PathResult> results(jobs.size());
            batch.layers = LayerOutput(options.layers.parts, results, {});
            for (std::size_t i = 0; i < jobs.size(); ++i) spawn(traced, batch, jobs[i], results[i]);
            for (PathState<N, false>& path : batch.paths) path.flight = 1;
            traceLanes(LaneScene::make(traced).value(), batch);
            shadowWalk(traced, batch);
            retire(traced, batch);
            int passes = 0;
            for (const PathResult& path : results) {
                ASSERT_NEAR(path.film.radiance.mean(), 0.5, 2e-5) << path.film.events;
                passes += path.film.events == 0;
            }
            EXPECT_GT(passes, 0);
        };
        if (traced.needs.chromatic)
            expectAll(Batch<3, false>(scene.lights));
        else
            expectAll(Batch<1, false>(scene.lights));
    }
}

/// The means over a picture of light by kind, then by group, over so many seeds.
std::vector<Moments> meansOfParts(const Scene& scene, PathTracer::Options options, int seeds,
                                  std::uint64_t firstSeed) {
    const std::vector<PathJob> jobs = jobsOf(options.width, 4);
    const std::size_t count = options.layers.parts.count();
    std::vector<Moments> means(count);
    std::vector<Rgb> parts(jobs.size() * count);
    for (int i = 0; i < seeds; ++i) {
        options.seed = hashOf(firstSeed, i);
        std::ranges::fill(parts, Rgb());
        trace(scene, options, jobs, {.parts = parts, .places = {}, .stops = {}});
        for (std::size_t part = 0; part < count; ++part) {
            double sum = 0;
            for (std::size_t k = 0; k < jobs.size(); ++k) sum += double{parts[k * count + part][1]};
            means[part].add(sum / static_cast<double>(jobs.size()));
        }
    }
    return means;
}

TEST_F(Lanes, KindsAndGroupsOfLightAreThoseOfPathsOneByOne) {
    const std::string lights = S::sun() + "group = \"sun\"\n" + S::air + "group = \"air\"\n";
    for (const char* medium : {"sigma_s = 40\nsigma_a = 0.2\ng = 0.8\n",
                               "sigma_s = [30, 20, 5]\nsigma_a = [0.1, 0.5, 1.5]\ng = 0.5\n"
                               "emission = { grid = \"heat\", scale = [8, 3, 1] }\n"
                               "group = \"fire\"\n",
                               "sigma_s = [1, 0.7, 0.5]\nsigma_a = [0.1, 0.2, 0.5]\ng = 0.5\n"}) {
        SCOPED_TRACE(medium);
        const Scene scene = subjects.scene(S::ball(medium) + lights);
        const LightDepths depths(scene, {}, ApproximateMedia(scene, {}));
        PathTracer::Options options;
        options.width = options.height = 6, options.lightDepths = &depths;
        options.layers.parts = {.kinds = true, .groups = {"sun", "air"}};
        const auto cameraDepths = CameraDepths::make(scene, options.width, options.height);
        options.cameraDepths = cameraDepths.get();
        const auto radiance = RadianceLattice::make(scene);
        options.radiance = radiance.get();
        const bool glows = std::string_view(medium).find("emission") != std::string_view::npos;
        if (glows) options.layers.parts.groups = {"fire", "sun", "air"};
        const auto lanes = meansOfParts(scene, options, 300, 1);
        options.lanes = false;
        const auto each = meansOfParts(scene, options, 300, 2);
        for (std::size_t part = 0; part < lanes.size(); ++part) {
            SCOPED_TRACE(options.layers.parts.name(part));
            const double error =
                std::hypot(lanes[part].standardError(), each[part].standardError());
            EXPECT_NEAR(lanes[part].mean(), each[part].mean(), 4 * error + 1e-6);
            EXPECT_LE(error, 0.02);
        }
        const auto placeOf = [&](LightKind kind) { return options.layers.parts.placeOf(kind); };
        EXPECT_GT(lanes[placeOf(LightKind::VolumeDirect)].mean(), 0.02);
        EXPECT_GT(lanes[placeOf(LightKind::VolumeIndirect)].mean(), 0.02);
        EXPECT_GT(lanes[placeOf(LightKind::Background)].mean(), 0.02);
        if (glows) {
            EXPECT_GT(lanes[placeOf(LightKind::Emission)].mean(), 1e-4);
        }
    }
}

/// To the rounding of floats that are far larger than their sum at times: of the parts, and of
/// light of about 1 within one, which its control variates take off again.
TEST_F(Lanes, PartsOfLightSumToEveryPaths) {
    const std::string lights = S::sun() + "group = \"sun\"\n" + S::air + "group = \"air\"\n";
    const Scene scene = subjects.scene(
        S::ball("sigma_s = [60, 40, 20]\nsigma_a = [0, 0.2, 1]\ng = 0.85\n") + lights);
    const LightDepths depths(scene, {}, ApproximateMedia(scene, {}));
    PathTracer::Options options;
    options.width = options.height = 10, options.lightDepths = &depths;
    options.layers.parts = {.kinds = true, .groups = {"sun", "air"}};
    const std::vector<PathJob> jobs = jobsOf(10, 4);
    const std::size_t count = options.layers.parts.count();
    std::vector<Rgb> parts(jobs.size() * count);
    const auto results = trace(scene, options, jobs, {.parts = parts, .places = {}, .stops = {}});
    for (std::size_t k = 0; k < jobs.size(); ++k)
        for (int c = 0; c < 3; ++c) {
            double kinds = 0, groups = 0, largest = 0;
            for (std::size_t part = 0; part < count; ++part) {
                const double light = double{parts[k * count + part][c]};
                (part < options.layers.parts.kindCount() ? kinds : groups) += light;
                largest = std::max(largest, std::abs(light));
            }
            const double rounding = 1e-5 * largest + 1e-7;
            ASSERT_NEAR(kinds, results[k].film.radiance[c], rounding) << k;
            ASSERT_NEAR(groups, results[k].film.radiance[c], rounding) << k;
        }
}

TEST_F(Lanes, LayersMattesAndDeepPixelsChangeNoBit) {
    for (const S::Named& kind : S::kinds()) {
        SCOPED_TRACE(kind.name);
        const Scene scene = subjects.scene(kind.text);
        RenderSettings settings;
        settings.width = 12, settings.height = 9, settings.endSample = 6, settings.seed = 5;
        const Film plain = render::render(scene, settings).film;
        settings.layers = {.depth = true,
                           .features = true,
                           .places = true,
                           .stops = true,
                           .parts = {.kinds = true, .groups = {}}};
        settings.deepError = 0.01;
        const Film full = render::render(scene, settings).film;
        settings.threads = 1, settings.crop = Film::Window{2, 3, 9, 8};
        const Film cropped = render::render(scene, settings).film;
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 12; ++x) {
                const Film::Pixel &a = plain.at(x, y), &b = full.at(x, y);
                ASSERT_EQ(a.samples, 6u);
                ASSERT_EQ(b.samples, 6u);
                ASSERT_EQ(a.events, b.events);
                ASSERT_EQ(a.alpha, b.alpha);
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(a.radiance[c], b.radiance[c]) << x << ' ' << y;
            }
        for (int y = 3; y < 8; ++y)
            for (int x = 2; x < 9; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(cropped.at(x, y).radiance[c], plain.at(x, y).radiance[c]);
    }
}

/// Where camera rays lose their light, by pixel: as one by one.
TEST_F(Lanes, StopsAreThoseOfPathsOneByOne) {
    for (const S::Named& kind : S::kinds()) {
        SCOPED_TRACE(kind.name);
        const Scene scene = subjects.scene(kind.text);
        PathTracer::Options options;
        options.width = options.height = 6;
        options.stoppedLight = options.layers.stops = true;
        const auto cameraDepths = CameraDepths::make(scene, options.width, options.height);
        options.cameraDepths = cameraDepths.get();
        const auto radiance = RadianceLattice::make(scene);
        options.radiance = radiance.get();
        const std::vector<PathJob> jobs = jobsOf(6, 4);
        std::array<std::array<Moments, 4>, 2> means;  // alpha, stopped light, and its depths
        for (const bool lanes : {false, true}) {
            options.lanes = lanes;
            for (int i = 0; i < 60; ++i) {
                options.seed = hashOf(lanes, i);
                std::vector<StopSample> stops(jobs.size());
                const auto results =
                    trace(scene, options, jobs, {.parts = {}, .places = {}, .stops = stops});
                std::array<double, 4> sums{};
                for (std::size_t k = 0; k < jobs.size(); ++k) {
                    sums[0] += double{results[k].film.alpha};
                    sums[1] += double{stops[k].firstDepth}, sums[2] += double{stops[k].halfDepth};
                    for (const StoppedLight::Stop& stop : results[k].stopped->stops)
                        sums[3] += stop.near * stop.amount();
                }
                for (std::size_t m = 0; m < 4; ++m)
                    means[lanes][m].add(sums[m] / static_cast<double>(jobs.size()));
            }
        }
        for (std::size_t m = 0; m < 4; ++m) {
            SCOPED_TRACE(m);
            EXPECT_GT(means[1][m].mean(), 0.1);
            expectAgree(Estimate(means[1][m]), Estimate(means[0][m]), 0.03);
        }
    }
}

}  // namespace

}  // namespace woodcock::test
