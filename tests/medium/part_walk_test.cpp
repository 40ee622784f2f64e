// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/medium/media.h"
#include "tests/support/expect_error.h"
#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace proof;

using namespace grid;
using namespace medium;
namespace {

std::vector<Segment> segments(const MediumPart& part, const TestRay& ray) {
    std::vector<Segment> all;
    PartWalk walk(part, part.indexRay(ray.origin, ray.direction), ray.tMax);
    Segment s;
    while (walk.next(s)) {
        all.push_back(s);
        if (all.size() > 100000) throw std::runtime_error("the walk does not end");
    }
    return all;
}

TEST(PartWalk, WhatMayNotBeMetIsNotMet) {
    int missed = 0;
    for (const PlainMedium& plain : {greyMedium(), hazyMedium(), chromaticMedium()}) {
        const Medium medium = plain.medium();
        for (const MediumPart& part : medium.parts)
            for (const TestRay& ray : testRays(medium, 2000, 3)) {
                const Vec3d d = ray.direction, inverse{1 / d.x, 1 / d.y, 1 / d.z};
                const bool may = part.mayMeet(ray.origin, inverse, ray.tMax);
                ASSERT_TRUE(may || segments(part, ray).empty());
                if (part.unbounded()) continue;
                // What misses a box that is clearly larger is known to miss.
                const Box3d box = part.worldBounds();
                const Vec3d more = box.size() * 1e-3;
                double t0 = 0, t1 = ray.tMax;
                if (clip({ray.origin, d}, {box.lower - more, box.upper + more}, t0, t1)) continue;
                ASSERT_FALSE(may);
                ++missed;
            }
    }
    EXPECT_GT(missed, 100);
}

TEST(PartWalk, SegmentsAreOrderedWithoutGapsAndBoundTheField) {
    RandomStream random(1);
    for (const PlainMedium& plain : {greyMedium(), hazyMedium(), chromaticMedium()}) {
        const Medium medium = plain.medium();
        for (std::size_t i = 0; i < medium.parts.size(); ++i) {
            const MediumPart& part = medium.parts[i];
            for (const TestRay& ray : testRays(medium, 200, 1)) {
                const std::vector<Segment> all = segments(part, ray);
                double t = all.empty() ? 0 : all[0].t0;
                for (const Segment& s : all) {
                    ASSERT_NEAR(s.t0, t, 1e-9);
                    ASSERT_GE(s.t0, t);
                    ASSERT_GE(s.t1, s.t0);
                    ASSERT_LE(s.t1, ray.tMax);
                    t = s.t1;
                    for (int k = 0; k < 5; ++k) {
                        const double at = s.t0 + (s.t1 - s.t0) * random.uniform();
                        const Rgb value = part.value(ray.origin + ray.direction * at);
                        for (const double f : value.c) {
                            ASSERT_LE(s.range.min, f + 1e-6);
                            ASSERT_GE(s.range.max, f - 1e-6);
                        }
                    }
                }
                if (part.unbounded()) {  // all of the ray, to its end
                    ASSERT_FALSE(all.empty());
                    EXPECT_EQ(all[0].t0, 0);
                    EXPECT_NEAR(t, ray.tMax, 1e-9);
                    continue;
                }
                for (int k = 0; k < 50; ++k) {  // nothing outside the segments
                    const double at = ray.tMax * random.uniform();
                    if (!all.empty() && at > all[0].t0 - 1e-9 && at < t + 1e-9) continue;
                    ASSERT_EQ(part.value(ray.origin + ray.direction * at), Rgb(0.0f));
                }
            }
        }
    }
}

TEST(PartWalk, AnEndlessBackgroundReachesInfinity) {
    const PlainMedium plain({{.grid = mixedGrid(1, 1, {0.25f})}});
    const Medium medium = plain.medium();
    for (Vec3d origin : {Vec3d{0, 0, 0}, Vec3d{-1000, 0, 0}, Vec3d{0, 1e9, 0}}) {
        const auto all =
            segments(medium.parts[0], {origin, {1, 0, 0}, std::numeric_limits<double>::infinity()});
        EXPECT_EQ(all.front().t0, 0);
        EXPECT_EQ(all.back().t1, std::numeric_limits<double>::infinity());
        EXPECT_EQ(all.back().range, (Range{0.25f, 0.25f}));
    }
}

TEST(PartWalk, AHomogeneousBoxIsOneSegment) {
    const PlainMedium plain({{.grid = {},
                              .box = {{-1, -1, -1}, {1, 1, 1}},
                              .worldFromIndex = Affine3d::scale({1e10, 1e10, 1e10})}});
    const Medium medium = plain.medium();
    const auto all = segments(medium.parts[0], {{-3e10, 0, 0}, {1, 0, 0}, 1e12});
    ASSERT_EQ(all.size(), 1u);
    EXPECT_DOUBLE_EQ(all[0].t0, 2e10);
    EXPECT_DOUBLE_EQ(all[0].t1, 4e10);
    EXPECT_EQ(all[0].range, (Range{1, 1}));
    EXPECT_TRUE(segments(medium.parts[0], {{-3e10, 2e10, 0}, {1, 0, 0}, 1e12}).empty());
    EXPECT_EQ(segments(medium.parts[0], {{0, 0, 0}, {1, 0, 0}, 5}).at(0).t1, 5);
}

TEST(MediumPart, CoefficientsAreWhatTheDescriptionSays) {
    RandomStream random(2);
    const PlainMedium plain = chromaticMedium();
    const Medium medium = plain.medium();
    for (const TestRay& ray : testRays(medium, 300, 2)) {
        const Vec3d p = ray.origin + ray.direction * (ray.tMax * random.uniform());
        Vec3d sigmaT;
        for (std::size_t i = 0; i < medium.parts.size(); ++i) {
            const Vec3d expected = plain.sigmaS(plain.parts()[i], p);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(medium.parts[i].sigmaS(p)[c], expected[c], 1e-6);
                sigmaT[c] += medium.parts[i].sigmaT(p)[c];
            }
        }
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sigmaT[c], plain.sigmaT(p)[c], 1e-6);
    }
    EXPECT_TRUE(medium.parts[0].chromatic());
    EXPECT_FALSE(greyMedium().medium().parts[0].chromatic());
    EXPECT_FALSE(tintedGlass().medium().parts[0].scatters());
}

TEST(MediumPart, FarFromItsGridIsBackground) {
    const Medium hazy = PlainMedium({{.grid = mixedGrid(1, 3, haze)}}).medium();
    for (double far : {1e6, 1e12, 1e30})
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(hazy.parts[0].value({far, -far, 0.5})[c], haze[static_cast<std::size_t>(c)]);
}

TEST(MediumPart, RefusesWhatHasNoMeaning) {
    MediumPart::Description d;
    d.box = {{0, 0, 0}, {1, 1, 1}};
    d.worldFromIndex.column[1] = {};
    expectError(ErrorKind::Input, "singular", [&] { MediumPart{d}; });
    d.worldFromIndex = {}, d.scattering = {1, -1, 1};
    expectError(ErrorKind::Input, "sigma_s is -1", [&] { MediumPart{d}; });
}

}  // namespace
}  // namespace woodcock::test
