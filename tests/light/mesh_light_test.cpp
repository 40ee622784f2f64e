// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/mesh_light.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "tests/light/emissive_triangles.h"
#include "woodcock/light/light_set.h"

namespace woodcock::test {

using namespace light;

namespace {

constexpr double belowOne = 1 - 0x1p-53;

double solidAngle(const Triangle& t, Vec3d from) {  // of a small triangle
    const Vec3d d = (t.corner[0] - from) + (t.corner[1] - t.corner[0]) * (1 / 3.0) +
                    (t.corner[2] - t.corner[0]) * (1 / 3.0);
    const Vec3d normal = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
    const double r = length(d);
    return std::abs(dot(normal, d)) / (2 * r * r * r);
}

/// n^2 equal parts of a triangle.
Triangles parts(const Triangle& t, int n) {
    const auto at = [&](int i, int j) {
        return t.corner[0] + (t.corner[1] - t.corner[0]) * (static_cast<double>(i) / n) +
               (t.corner[2] - t.corner[0]) * (static_cast<double>(j) / n);
    };
    Triangles result;
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            result.push_back({{at(i, j), at(i + 1, j), at(i, j + 1)}, t.radiance});
            if (i + j + 1 < n)
                result.push_back({{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, t.radiance});
        }
    return result;
}

/// The one of parts(t, n) that holds the point.
std::size_t partOf(const Triangle& t, int n, Vec3d p) {
    const Vec3d e1 = t.corner[1] - t.corner[0], e2 = t.corner[2] - t.corner[0];
    const Vec3d normal = cross(e1, e2), d = p - t.corner[0];
    const double u = dot(cross(d, e2), normal) / dot(normal, normal);
    const double v = dot(cross(e1, d), normal) / dot(normal, normal);
    const int i = std::clamp(static_cast<int>(u * n), 0, n - 1);
    const int j = std::clamp(static_cast<int>(v * n), 0, n - 1 - i);
    const bool second = i + j + 1 < n && (u + v) * n > i + j + 1;
    int before = 0;
    for (int k = 0; k < i; ++k) before += 2 * (n - k) - 1;
    return static_cast<std::size_t>(before + 2 * j + second);
}

/// Samples fall onto the parts of all triangles as the integral of pdf() says: chi-square. What is
/// left to 1 are samples that end at a group of triangles which all turn out to be dark.
void expectDensity(const Triangles& triangles, Vec3d from) {
    constexpr int side = 4, fine = 16, samples = 60000;
    const MeshLight light(triangles);
    std::vector<double> expected;
    for (std::uint32_t k = 0; k < triangles.size(); ++k)
        for (const Triangle& part : parts(triangles[k], side)) {
            double sum = 0;
            for (const Triangle& piece : parts(part, fine)) {
                const Vec3d middle = (piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3.0;
                sum += light.pdf(from, k, middle) * solidAngle(piece, from);
            }
            expected.push_back(sum);
        }
    const double all = std::accumulate(expected.begin(), expected.end(), 0.0);
    const bool single = triangles.size() == 1;
    EXPECT_GT(all, single ? 1 - 2e-3 : 0.5);
    EXPECT_LT(all, 1 + 2e-3);

    std::vector<double> found(expected.size());
    double nothing = 0;
    RandomStream random(5);
    for (int i = 0; i < samples; ++i) {
        const Sample s = draw(light, from, random);
        if (!(s.light.pdf > 0)) {
            ASSERT_EQ(s.light.weight, Rgb(0.0f));
            ++nothing;
            continue;
        }
        const Vec3d position = from + s.light.direction * s.light.distance;
        const Triangle& t = triangles[s.triangle];
        ASSERT_NEAR(light.pdf(from, s.triangle, position) / s.light.pdf, 1, 1e-6);
        ASSERT_NEAR(s.light.weight[0] * s.light.pdf / t.radiance[0], 1, 1e-6);
        found[s.triangle * side * side + partOf(t, side, position)] += 1;
    }
    double chi2 = 0, restFound = nothing, restExpected = samples * std::max(0.0, 1 - all);
    int freedom = -1;
    const auto add = [&](double f, double e) { chi2 += (f - e) * (f - e) / e, ++freedom; };
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const double e = expected[i] * samples;
        if (e >= 8)
            add(found[i], e);
        else
            restFound += found[i], restExpected += e;
    }
    if (restExpected >= 8) add(restFound, restExpected);
    ASSERT_GT(freedom, 3);
    EXPECT_LT(chi2, freedom + 5 * std::sqrt(2.0 * freedom));
}

const Triangle someTriangle{{Vec3d{0, 0, 0}, Vec3d{1, 0.2, 0.1}, Vec3d{0.3, 0.9, -0.2}}, Rgb(2.0f)};

TEST(MeshLight, SamplesATriangleAsItsDensitySays) {
    const Vec3d normal{-0.13, 0.23, 0.84};
    for (double distance : {0.3, 1.0, 30.0, 4000.0, 9000.0, 1e7}) {
        SCOPED_TRACE(distance);
        expectDensity({someTriangle}, Vec3d{0.2, 0.5, 0} + normal * distance);
        expectDensity({someTriangle}, Vec3d{-0.7 * distance, 0.5, 0} + normal * distance);
    }
    Triangle both = someTriangle;
    both.bothSides = true;
    expectDensity({both}, Vec3d{0.2, 0.5, -0.8});
    const Triangle sliver{{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0.4, 1e-5, 0}}, Rgb(1.0f)};
    expectDensity({sliver}, {0.1, 0.2, 0.3});
    expectDensity({sliver}, {3, 0.2, 1e-3});
}

TEST(MeshLight, SamplesATriangleAtAnyScale) {
    for (double scale : {1e-6, 1e-4, 1e5, 1e9}) {
        SCOPED_TRACE(scale);
        const Vec3d from = Vec3d{0.2, -0.5, 0.9} * scale;
        expectDensity(moved({someTriangle}, scale, {}), from);
        expectDensity(moved({someTriangle}, 1e-2 * scale, from + Vec3d{0.1, 0, -1} * scale), from);
    }
}

TEST(MeshLight, SamplesManyTrianglesAsTheirDensitySays) {
    RandomStream random(3);
    const Triangles triangles = cloud(40, 0.3, random);
    for (double distance : {0.0, 0.3, 1.0, 5.0, 1000.0}) {
        SCOPED_TRACE(distance);
        for (double scale : {1e-4, 1.0, 1e5})
            expectDensity(moved(triangles, scale, {}), direction(random) * distance * scale);
    }
}

TEST(MeshLight, NeglectsNoTriangleThatIsSeen) {
    RandomStream random(4);
    const auto check = [&](const Triangles& triangles, double scale) {
        const MeshLight light(moved(triangles, scale, {}));
        for (int i = 0; i < 300; ++i) {
            const double height = std::exp(-12 * random.uniform());
            const Vec3d from = Vec3d{4 * random.uniform() - 2, 4 * random.uniform() - 2,
                                     i % 2 ? height : 4 * random.uniform() - 2} *
                               scale;
            bool any = false;
            for (std::uint32_t k = 0; k < triangles.size(); ++k) {
                const auto& c = light.triangles()[k].corner;
                const Vec3d normal = cross(c[1] - c[0], c[2] - c[0]);
                const double above = dot(normal, from - c[0]);
                const bool seen = above > 0 || (light.triangles()[k].bothSides && above < 0);
                any |= seen;
                EXPECT_EQ(light.pdf(from, k, (c[0] + c[1] + c[2]) / 3.0) > 0, seen);
            }
            EXPECT_GE(light.facingIrradiance(from) > 0, any);
        }
    };
    // A plane; one that is bent a little, convex and concave
    for (double bend : {0.0, 1e-9, 1e-5, -1e-3, 0.2}) {
        Triangles plane;
        for (int x = -5; x < 5; ++x)
            for (int y = -5; y < 5; ++y)
                addRectangle(plane, {x * 0.2, y * 0.2, bend * (x * x + y * y)},
                             {0.2, 0, 0.2 * bend * x}, {0, 0.2, 0.2 * bend * y});
        for (double scale : {1e-4, 1.0, 1e5}) check(plane, scale);
    }
    for (double scale : {1e-4, 1.0, 1e5}) {
        check(cloud(100, 0.05, random), scale);
        check(cube({}, false), scale);
    }
}

TEST(MeshLight, InItsPlaneItSendsNothing) {
    const MeshLight light({{{Vec3d{0, 0, 1}, Vec3d{1, 0, 1}, Vec3d{0, 1, 1}}, Rgb(1.0f), true}});
    for (Vec3d from : {Vec3d{0.2, 0.2, 1}, Vec3d{3, 3, 1}, Vec3d{0, 0, 1}, Vec3d{0, 1, 1},
                       Vec3d{0.5, 0.5, 1}, Vec3d{0.5, 0, 1}, Vec3d{2, 0, 1}}) {
        EXPECT_EQ(light.sample(from, 0.3, 0.6).weight, Rgb(0.0f));
        EXPECT_EQ(light.pdf(from, 0, {0.3, 0.3, 1}), 0);
        EXPECT_EQ(light.facingIrradiance(from), 0);
    }
}

TEST(MeshLight, TakesTheEndsOfRandomNumbers) {
    RandomStream random(9);
    const Triangles triangles = cloud(200, 0.2, random);
    for (double scale : {1e-4, 1.0, 1e5}) {
        const MeshLight light(moved(triangles, scale, {}));
        int lit = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec3d from = direction(random) * (i % 2 ? 0.5 * scale : 1e4 * scale);
            for (double u0 : {0.0, 0x1p-53, 0.5, belowOne})
                for (double u1 : {0.0, 0x1p-53, 0.5, belowOne}) {
                    const LightSample s = light.sample(from, u0, u1);
                    if (s.pdf == 0 && s.weight == Rgb(0.0f)) continue;
                    ++lit;
                    ASSERT_NEAR(length(s.direction), 1, 1e-12);
                    ASSERT_TRUE(s.weight[0] > 0 && s.weight.isFinite());
                    ASSERT_TRUE(s.pdf > 0 && std::isfinite(s.pdf));
                    const auto& c = light.triangles()[s.emitter].corner;
                    Box3d box;
                    for (Vec3d corner : c) box.add(corner);
                    const Vec3d off = from + s.direction * s.distance - box.centre();
                    ASSERT_LT(length(off), length(box.size()) / 2 + 1e-11 * s.distance);
                }
        }
        EXPECT_GT(lit, 500 * 16 * 0.5);
    }
}

TEST(MeshLight, SendsOutWhatVariesOverATriangle) {
    Triangle both = someTriangle;
    both.bothSides = true;
    const MeshLight light({someTriangle, both},
                          [](std::uint32_t triangle, double b1, double b2, bool front) {
                              return Rgb(static_cast<float>(b1), static_cast<float>(b2),
                                         static_cast<float>(10 * triangle + front));
                          });
    RandomStream random(7);
    for (double distance : {1e-9, 0.3, 30.0, 1e5})
        for (double side : {1.0, -1.0}) {
            const auto& c = someTriangle.corner;
            const Vec3d from = (c[1] + c[2]) / 3.0 + Vec3d{-0.13, 0.23, 0.84} * (side * distance);
            for (int i = 0; i < 200; ++i) {
                const Sample s = draw(light, from, random);
                if (!(s.light.pdf > 0)) continue;
                const Rgb sent = s.light.weight * static_cast<float>(s.light.pdf);
                const Vec3d expected = c[0] + (c[1] - c[0]) * sent[0] + (c[2] - c[0]) * sent[1];
                const Vec3d position = from + s.light.direction * s.light.distance;
                EXPECT_LT(length(expected - position), 1e-6 + 1e-14 * distance);
                EXPECT_NEAR(sent[2], 10 * s.triangle + (side > 0), 1e-5);
            }
        }
}

TEST(MeshLight, LeavesOutWhatCannotShine) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Triangles triangles(7, someTriangle);
    triangles[0].corner[2] = triangles[0].corner[1];
    triangles[1].corner[0].x = nan;
    triangles[2].radiance = Rgb(0.0f);
    triangles[3].radiance = Rgb(infinity);
    triangles[5].corner = {Vec3d{1, 1, 1}, Vec3d{2, 2, 2}, Vec3d{3, 3, 3}};
    triangles[6].radiance = {0, 0, 3};
    const MeshLight light(triangles);
    std::vector<int> chosen(7);
    RandomStream random(1);
    for (int i = 0; i < 5000; ++i) {
        const Sample s = draw(light, {0.1, 0.2, 2}, random);
        ASSERT_TRUE(s.light.weight.isFinite());
        ++chosen[s.triangle];
    }
    EXPECT_NEAR(chosen[4], 5000 * 2.0 / 3, 4 * std::sqrt(5000 * 2.0 / 9));
    EXPECT_EQ(chosen[4] + chosen[6], 5000);
    for (std::uint32_t k : {0u, 1u, 2u, 3u, 5u}) EXPECT_EQ(light.pdf({0.1, 0.2, 2}, k, {}), 0);
    EXPECT_TRUE(isFinite(light.centre()));

    for (const Triangles& none : {Triangles{}, Triangles{triangles[0], triangles[2]}}) {
        const MeshLight dark(none);
        EXPECT_EQ(dark.sample({0, 0, 1}, 0.5, 0.5).weight, Rgb(0.0f));
        EXPECT_EQ(dark.facingIrradiance({0, 0, 1}), 0);
        EXPECT_EQ(dark.power(), 0);
    }
}

TEST(MeshLight, TellsTrianglesInOnePlaceApart) {
    expectDensity(Triangles(50, someTriangle), {0.3, 0.3, 1});
}

TEST(MeshLight, ReachesTrianglesThatShrinkTowardsAPoint) {
    Triangles triangles;  // each split by place alone would cut off only a few
    for (double size = 1; size > 1e-60; size /= 2)
        triangles.push_back({moved({someTriangle}, size, {})[0].corner,
                             Rgb(static_cast<float>(std::min(1 / (size * size), 1e36)))});
    const MeshLight light(triangles);
    const Vec3d from{0.3, -0.3, 1};
    for (std::uint32_t k = 0; k < triangles.size(); ++k)
        EXPECT_GT(light.pdf(from, k, triangles[k].corner[1]), 0) << k;
    std::vector<int> found(triangles.size());
    RandomStream random(2);
    for (int i = 0; i < 40000; ++i) {
        const Sample s = draw(light, from, random);
        ASSERT_GT(s.light.pdf, 0);
        const Vec3d position = from + s.light.direction * s.light.distance;
        ASSERT_NEAR(light.pdf(from, s.triangle, position) / s.light.pdf, 1, 1e-6);
        ++found[s.triangle];
    }
    // As bright as each other, but for the largest and those whose radiance was cut
    for (std::size_t i = 6; i < 55; ++i)
        EXPECT_NEAR(found[i], found[30], 6 * std::sqrt(2.0 * found[30])) << i;
}

TEST(MeshLight, PowerAndCentre) {
    Triangles square;
    addRectangle(square, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 5, 2});
    EXPECT_NEAR(MeshLight(square).power(), 4 * 5 * pi, 1e-12);
    EXPECT_NEAR(length(MeshLight(square).centre() - Vec3d{1, 1, 0}), 0, 1e-15);
    for (Triangle& t : square) t.bothSides = true;
    EXPECT_NEAR(MeshLight(square).power(), 8 * 5 * pi, 1e-12);
    // From afar the importance is the irradiance: area / distance^2, mean over channels
    EXPECT_NEAR(MeshLight(square).facingIrradiance({1, 1, 1000}) / (4 * 8 / 3.0 * 1e-6), 1, 0.01);
}

TEST(LightSet, HoldsEmissiveSurfaces) {
    Triangles square;
    addRectangle(square, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Rgb(3.0f));
    const LightSet lights({PointLight{{0, 0, 2}, Rgb(1.0f)}, MeshLight(square)});
    EXPECT_EQ(lights.meshIndex(), 1);
    ASSERT_NE(lights.mesh(), nullptr);
    EXPECT_EQ(lights.mesh()->triangles().size(), 2u);
    EXPECT_EQ(lights.sampled().size(), 2u);
    EXPECT_EQ(lights.local().size(), 1u);
    const LightSet none({PointLight{{0, 0, 2}, Rgb(1.0f)}});
    EXPECT_EQ(none.meshIndex(), -1);
    EXPECT_EQ(none.mesh(), nullptr);

    const Vec3d from{0.4, 0.3, 1};
    const LightSample s = lights.sample(1, from, 0.2, 0.7),
                      same = lights.mesh()->sample(from, 0.2, 0.7);
    EXPECT_EQ(s.direction, same.direction);
    EXPECT_EQ(s.weight, same.weight);
    EXPECT_EQ(lights.pdf(1, from, s.direction), 0);
    EXPECT_EQ(lights.distantRadiance(1, s.direction, false), Rgb(0.0f));
    EXPECT_GT(lights.typicalRadiance({{0, 0, 0}, {1, 1, 1}}),
              none.typicalRadiance({{0, 0, 0}, {1, 1, 1}}));

    std::vector<float> p(2);
    const medium::PhaseFunction narrow = medium::HenyeyGreenstein(0.999);
    lights.pickProbabilities({from, {0, 0, 1}, &narrow}, p);
    EXPECT_GT(p[1], 0);
    EXPECT_NEAR(p[0] + p[1], 1, 1e-6);
    lights.pickProbabilities({{0.4, 0.3, -1}, {0, 0, 1}}, p);  // behind it
    EXPECT_EQ(p, (std::vector<float>{1, 0}));
}

}  // namespace
/// A cube that turns, drifts and grows within the shutter, and one beside it that jumps.
TEST(MeshLight, WhatMovesIsFoundWhereItIs) {
    Triangles all = cube({0, 0, 0}, false);
    const Triangles second = cube({5, 0, 0}, false);
    all.insert(all.end(), second.begin(), second.end());
    const auto still = static_cast<std::uint32_t>(all.size());
    addRectangle(all, {-4, -4, -4}, {8, 0, 0}, {0, 8, 0});
    const std::array ends{0.0, 1.0};
    const std::array half{0.0, 0.5, 1.0};
    const auto turning = [](double u) {
        return Affine3d::translate({3 * u, 0, -2 * u}) * Affine3d::rotate(1, 150 * u) *
               Affine3d{{Vec3d{1 + u, 0, 0}, {0, 1, 0}, {0, 0, 1 - 0.5 * u}}, {}};
    };
    const auto after = [](double u) { return Affine3d::translate({0, u < 0.5 ? 0.0 : 4.0, 0}); };
    const auto before = [](double u) { return Affine3d::translate({0, u > 0.5 ? 4.0 : 0.0, 0}); };
    const auto turn = MovingTransform::follow(turning, turning, ends),
               jump = MovingTransform::follow(after, before, half);
    const MeshLight light(all, {}, {{0, 12, turn}, {12, 24, jump}});
    ASSERT_TRUE(light.moves());
    RandomStream random(3);
    int found = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto time = static_cast<float>(random.uniform());
        Triangles there = all;
        for (std::uint32_t t = 0; t < still; ++t)
            for (Vec3d& corner : there[t].corner)
                corner = (t < 12 ? turn : jump)->at(double{time}).point(corner);
        const Vec3d from = direction(random) * (9 * random.uniform());
        // All that faces a point can be drawn there, ...
        const auto any =
            static_cast<std::uint32_t>(random.uniform() * static_cast<double>(all.size()));
        const Triangle& t = there[any];
        const Vec3d middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
        const Vec3d normal = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
        const bool faces = dot(normal, from - middle) > 1e-9;
        EXPECT_EQ(light.pdf(from, any, middle, time) > 0, faces);
        // ... and what is drawn lies on its triangle, with the density that pdf() tells.
        const LightSample s = light.sample(from, random.uniform(), random.uniform(), time);
        if (s.emitter == LightSample::none) continue;
        ++found;
        const Vec3d point = from + s.direction * s.distance;
        const Triangle& drawn = there[s.emitter];
        const Vec3d n =
            normalize(cross(drawn.corner[1] - drawn.corner[0], drawn.corner[2] - drawn.corner[0]));
        EXPECT_NEAR(dot(n, point - drawn.corner[0]), 0, 1e-9);
        EXPECT_NEAR(light.pdf(from, s.emitter, point, time) / s.pdf, 1, 1e-9);
    }
    EXPECT_GT(found, 1000);
}

}  // namespace woodcock::test
