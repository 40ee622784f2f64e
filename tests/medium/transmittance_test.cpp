// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/medium/media.h"
#include "tests/support/expect_mean.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::test {

using namespace medium;
using namespace proof;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int N>
std::array<Moments, N> track(const Medium& medium, const TestRay& ray, Spectrum<N> contribution,
                             float roulette, int count, std::uint64_t seed) {
    std::vector<TransmittanceQuery<N>> queries(static_cast<std::size_t>(count),
                                               {.origin = ray.origin,
                                                .direction = ray.direction,
                                                .tMax = ray.tMax,
                                                .random = RandomStream(),
                                                .roulette = roulette,
                                                .contribution = contribution});
    for (std::size_t i = 0; i < queries.size(); ++i)
        queries[i].random = RandomStream(hashOf(seed, i));
    TrackingCounters counters;
    trackTransmittance<N>(medium, queries, counters);
    std::array<Moments, N> moments;
    for (const auto& q : queries)
        for (int c = 0; c < N; ++c) moments[static_cast<std::size_t>(c)].add(q.contribution[c]);
    return moments;
}

/// The estimate's mean on many rays, each and all together. Means of rays of which next to nothing
/// arrives are made of so few samples that only the whole can be judged.
template <int N>
void expectExact(const PlainMedium& plain, const Medium& medium, Spectrum<N> contribution,
                 float roulette, const std::string& what) {
    Moments pooled;
    const std::vector<TestRay> rays = testRays(medium, 20, 4);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const TestRay& ray = rays[i];
        const Vec3d transmittance = plain.transmittance(ray.origin, ray.direction, ray.tMax);
        const auto m = track<N>(medium, ray, contribution, roulette, 3000, i);
        for (int c = 0; c < N; ++c) {
            const Moments& channel = m[static_cast<std::size_t>(c)];
            const double expected = contribution[c] * transmittance[c];
            if (expected > 0.02) expectMean(channel, expected, 0.02, what);
            pooled.add(channel.mean() - expected);
        }
    }
    expectMean(pooled, 0, 0.003, what + ", all rays");
}

TEST(Transmittance, IsExactInTheMean) {
    expectExact<1>(greyMedium(), greyMedium().medium(), Spectrum<1>(1), 0, "grey");
    expectExact<3>(greyMedium(), greyMedium().medium(), {1, 1, 1}, 0, "grey in three channels");
    expectExact<1>(hazyMedium(), hazyMedium().medium(), Spectrum<1>(1), 0, "hazy");
    expectExact<3>(chromaticMedium(), chromaticMedium().medium(), {1, 1, 1}, 0, "chromatic");
    expectExact<3>(tintedGlass(), tintedGlass().medium(), {1, 1, 1}, 0, "glass");
}

TEST(Transmittance, MajorantsChangeNoMean) {
    for (double scale : {2.0, 8.0})
        for (int smallestLog2 : {1, 3, 6}) {
            expectExact<1>(greyMedium(), greyMedium().medium(scale, smallestLog2), Spectrum<1>(1),
                           0, "grey");
            expectExact<3>(chromaticMedium(), chromaticMedium().medium(scale, smallestLog2),
                           {1, 1, 1}, 0, "chromatic");
        }
}

/// Many collisions in cells that are too shallow to be cut, but that carry a control.
TEST(Transmittance, MajorantsChangeNoMeanWhereNothingIsEmpty) {
    PlainGrid grid;
    for (int i = 0; i < 27; ++i)
        grid.setLeaf(Vec3i{i % 3, i / 3 % 3, i / 9} * 8,
                     [](Vec3i v, int) { return v.y & 1 ? 2.0f : 1.0f; });
    const PlainMedium plain({{.grid = grid, .scattering = Rgb(0.1f)}});
    const TestRay ray{{-4, 10.2, 11.5}, {1, 0, 0}, 30};
    const double expected = plain.transmittance(ray.origin, ray.direction, ray.tMax).x;
    for (double scale : {1.0, 8.0, 64.0})
        for (float roulette : {0.0f, 0.05f})
            expectMean(track<1>(plain.medium(scale, 3), ray, Spectrum<1>(1), roulette, 20000, 1)[0],
                       expected, 0.003, "nowhere empty");
}

TEST(Transmittance, RouletteChangesNoMean) {
    for (float threshold : {0.1f, 0.5f, 1.5f}) {
        expectExact<1>(greyMedium(), greyMedium().medium(), Spectrum<1>(0.6f), threshold, "grey");
        expectExact<1>(hazyMedium(), hazyMedium().medium(), Spectrum<1>(0.6f), threshold, "hazy");
        expectExact<3>(chromaticMedium(), chromaticMedium().medium(), {0.6f, 0.2f, 0.05f},
                       threshold, "chromatic");
        expectExact<3>(tintedGlass(), tintedGlass().medium(), {0.1f, 0.2f, 0.6f}, threshold,
                       "glass");
    }
}

TEST(Transmittance, HasNoNoiseWhereTheFieldIsFlat) {
    PlainGrid grid;
    grid.setTile({0, 0, 0}, 128, {0.25f});
    grid.setTile({128, 0, 0}, 128, {0.25f});
    const PlainMedium plain(
        {{.grid = grid, .absorption = {0.1f, 0.2f, 0}, .scattering = {0, 0.1f, 0.5f}},
         {.grid = {}, .box = {{-9, -9, -9}, {200, 200, 200}}, .scattering = Rgb(0.01f)}});
    for (int smallestLog2 : {1, 5}) {
        const TestRay ray{{3, 4, 5}, normalize(Vec3d{2, 0.5, 0.25}), 100};
        const Vec3d expected = plain.transmittance(ray.origin, ray.direction, ray.tMax);
        const auto m = track<3>(plain.medium(1, smallestLog2), ray, {1, 1, 1}, 0, 100, 1);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(m[c].variance(), 0);
            EXPECT_NEAR(m[c].mean() / expected[static_cast<int>(c)], 1, 1e-5);
        }
    }
}

TEST(Transmittance, AnyOpticalDepthIsFiniteFastAndRight) {
    for (double depth : {1e-10, 1e-4, 88.0, 104.0, 1e4, 1e8})
        for (bool flat : {true, false}) {
            PlainGrid grid;
            for (int x = 0; x < 8; ++x)
                grid.setLeaf({x * 8, 0, 0}, [&](Vec3i v, int) {
                    return flat ? 1.0f : static_cast<float>(v.x % 3);
                });
            const PlainMedium plain(
                {{.grid = grid, .scattering = Rgb(static_cast<float>(depth / 64))}});
            const TestRay ray{{-5, 3.5, 3.5}, {1, 0, 0}, infinity};
            const Vec3d expected = plain.transmittance(ray.origin, ray.direction, 100);
            for (float roulette : {0.0f, 0.1f}) {
                const auto m = track<1>(plain.medium(), ray, Spectrum<1>(1), roulette, 1000, 2);
                ASSERT_TRUE(std::isfinite(m[0].mean()));
                const double rare = depth < 1 ? 2 * depth : 0;  // too few to make an error of
                ASSERT_NEAR(m[0].mean(), expected.x, 4 * m[0].standardError() + 2e-7 + rare);
                EXPECT_LE(m[0].standardError(), 1e-5);
            }
        }
}

TEST(Transmittance, AThinSpikeInADeepFogEndsAtOnce) {  // no collision of the spike is waited for
    PlainGrid grid(1, {1});
    grid.setLeaf({0, 0, 0}, [](Vec3i v, int) {
        return v == Vec3i{4, 4, 4} ? 1e9f : v == Vec3i{0, 0, 0} ? 2.0f : 1.0f;
    });
    const Medium medium = PlainMedium({{.grid = grid, .scattering = Rgb(1e3f)}}).medium(1, 3);
    std::vector<TransmittanceQuery<1>> query{{.origin = {-5, 1.5, 1.5},
                                              .direction = {1, 0, 0},
                                              .tMax = 20,
                                              .random = RandomStream(1),
                                              .contribution = Spectrum<1>(1)}};
    TrackingCounters counters;
    trackTransmittance<1>(medium, query, counters);
    EXPECT_EQ(query[0].contribution[0], 0);
    EXPECT_LT(counters.collisions, 1000u);
}

TEST(Transmittance, AThousandPartsMultiply) {
    std::vector<PlainPart> parts;
    for (int i = 0; i < 1000; ++i) {
        const Affine3d shift = Affine3d::translate({0.01 * i, 0, 0});
        if (i % 100)
            parts.push_back({.grid = {},
                             .box = {{0, -9, -9}, {5, 9, 9}},
                             .worldFromIndex = shift,
                             .scattering = Rgb(0.0002f)});
        else
            parts.push_back(
                {.grid = mixedGrid(9), .worldFromIndex = shift, .scattering = Rgb(0.01f)});
    }
    const PlainMedium plain(parts);
    const TestRay ray{{-30, 0.5, 0.5}, {1, 0, 0}, 100};
    const Vec3d expected = plain.transmittance(ray.origin, ray.direction, ray.tMax);
    const Medium medium = plain.medium();
    expectMean(track<1>(medium, ray, Spectrum<1>(1), 0, 1500, 3)[0], expected.x, 0.01,
               "a thousand");
}

TEST(Transmittance, IsOneWhereThereIsNothing) {
    const TestRay ray{{0, 0, 0}, {1, 0, 0}, infinity};
    EXPECT_EQ(track<1>(Medium{}, ray, Spectrum<1>(0.5f), 0, 1, 1)[0].mean(), 0.5);
    const Medium empty = PlainMedium({{.grid = PlainGrid()}}).medium();
    EXPECT_EQ(track<1>(empty, ray, Spectrum<1>(0.5f), 0, 1, 1)[0].mean(), 0.5);
    const Medium fog = PlainMedium({{.grid = mixedGrid(1, 1, {1})}}).medium();
    EXPECT_EQ(track<1>(fog, ray, Spectrum<1>(0.5f), 0, 1, 1)[0].mean(), 0);  // endless
}

}  // namespace
}  // namespace woodcock::test
