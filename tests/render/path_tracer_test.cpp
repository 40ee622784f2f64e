// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/path_tracer.h"

#include <gtest/gtest.h>

#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace proof;
using namespace render;

namespace {

/// Fog outside, coloured fog in glass, and a floor: flights and shadow rays in several media, some
/// of which only absorb, with local and distant lights.
Scene fogsAndGlass() {
    return sceneFrom(
        "[[volume]]\nbox = { min = [-3, -3, -3], max = [3, 3, 3] }\nsigma_a = 0.1\nsigma_s = 0.3\n"
        "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.4\n"
        "[[material]]\nname = \"edge\"\ntype = \"interface\"\n"
        "[[surface]]\nmaterial = \"glass\"\nsphere = { centre = [0, 0, 0], radius = 0.8 }\n"
        "medium = { sigma_a = [0.2, 0.1, 0.4], sigma_s = [1, 2, 0.5] }\n"
        "[[surface]]\nmaterial = \"edge\"\nsphere = { centre = [1.3, 0, 0], radius = 0.6 }\n"
        "medium = { sigma_a = [2, 1, 0.5] }\n"
        "[[surface]]\nplane = {}\ntransform = { translate = [0, -1, 0] }\n"
        "[[light]]\ntype = \"sphere\"\nposition = [-1, 1.5, 1]\nradius = 0.2\nradiance = 20\n"
        "[[light]]\ntype = \"sun\"\ndirection = [0.5, -1, -0.3]\nirradiance = 2\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.2\n"
        "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 35\n");
}

std::vector<PathJob> someJobs() {
    std::vector<PathJob> jobs;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x)
            for (std::uint32_t s = 0; s < 4; ++s) jobs.push_back({x, y, s});
    return jobs;
}

/// In one batch, paths of many media are sorted into runs; alone, each is a run of its own. The
/// same tracer does both: nothing is left over from one call to the next.
TEST(PathTracer, ResultsDoNotDependOnTheRestOfTheBatch) {
    const Scene scene = fogsAndGlass();
    const Needs needs = findNeeds(scene);
    ASSERT_TRUE(needs.surfaces && needs.localLights && needs.chromatic);
    PathTracer::Options options;
    options.width = options.height = 12;
    options.layers.features = true;
    const auto tracer = PathTracer::make(scene, needs, options);
    const auto never = [] { return false; };
    const std::vector<PathJob> jobs = someJobs();
    std::vector<PathResult> together(jobs.size());
    RenderCounters ofAll, ofEach;
    ASSERT_TRUE(tracer->trace(jobs, together, never, ofAll));
    int lit = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        PathResult alone;
        ASSERT_TRUE(tracer->trace({&jobs[i], 1}, {&alone, 1}, never, ofEach));
        EXPECT_EQ(alone.film.radiance, together[i].film.radiance);
        EXPECT_EQ(alone.film.alpha, together[i].film.alpha);
        EXPECT_EQ(alone.film.events, together[i].film.events);
        EXPECT_EQ(alone.depth.transmittance, together[i].depth.transmittance);
        EXPECT_EQ(alone.depth.weightedDepth, together[i].depth.weightedDepth);
        lit += alone.film.radiance.maximum() > 0;
    }
    EXPECT_GT(lit, 400);
    EXPECT_EQ(ofAll.paths, jobs.size());
    EXPECT_EQ(ofAll.paths, ofEach.paths);
    EXPECT_EQ(ofAll.scatterings, ofEach.scatterings);
    EXPECT_EQ(ofAll.shadowRays, ofEach.shadowRays);
    EXPECT_EQ(ofAll.surfaceRays, ofEach.surfaceRays);
    EXPECT_EQ(ofAll.distanceCollisions, ofEach.distanceCollisions);
    EXPECT_EQ(ofAll.shadowCollisions, ofEach.shadowCollisions);
}

/// The time is drawn in dimensions of its own.
TEST(PathTracer, WhatStandsStillHasTheSameBitsAtAnyTime) {
    const Scene scene = fogsAndGlass();
    Needs needs = findNeeds(scene);
    ASSERT_FALSE(needs.motion);
    PathTracer::Options options;
    options.width = options.height = 12;
    const std::vector<PathJob> jobs = someJobs();
    const auto trace = [&] {
        std::vector<PathResult> results(jobs.size());
        RenderCounters counters;
        EXPECT_TRUE(PathTracer::make(scene, needs, options)
                        ->trace(
                            jobs, results, [] { return false; }, counters));
        return results;
    };
    const auto sharp = trace();
    needs.motion = true;
    const auto moving = trace();
    for (std::size_t i = 0; i < jobs.size(); ++i)
        EXPECT_EQ(sharp[i].film.radiance, moving[i].film.radiance);
}

TEST(PathTracer, AStoppedCallLeavesTheCountersAndTheNextCallAlone) {
    const Scene scene = fogsAndGlass();
    PathTracer::Options options;
    options.width = options.height = 12;
    const auto tracer = PathTracer::make(scene, findNeeds(scene), options);
    const std::vector<PathJob> jobs = someJobs();
    std::vector<PathResult> results(jobs.size()), again(jobs.size());
    RenderCounters counters;
    int rounds = 0;
    EXPECT_FALSE(tracer->trace(
        jobs, results, [&] { return ++rounds > 3; }, counters));
    EXPECT_EQ(counters.paths, 0u);
    EXPECT_TRUE(tracer->trace(
        jobs, results, [] { return false; }, counters));
    EXPECT_EQ(counters.paths, jobs.size());
    const auto fresh = PathTracer::make(scene, findNeeds(scene), options);
    RenderCounters ofFresh;
    EXPECT_TRUE(fresh->trace(
        jobs, again, [] { return false; }, ofFresh));
    EXPECT_EQ(counters.surfaceRays, ofFresh.surfaceRays);
    for (std::size_t i = 0; i < jobs.size(); ++i)
        EXPECT_EQ(results[i].film.radiance, again[i].film.radiance);
}

}  // namespace
}  // namespace woodcock::test
