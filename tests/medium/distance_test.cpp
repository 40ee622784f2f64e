// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/medium/media.h"
#include "tests/support/expect_mean.h"
#include "woodcock/medium/tracking.h"

namespace woodcock::test {

using namespace proof;

using namespace medium;
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Settings {
    float roulette = 0;
    bool absorptionToo = false;
    int count = 3000;
};

template <int N>
std::vector<DistanceQuery<N>> track(const Medium& medium, const TestRay& ray,
                                    Spectrum<N> throughput, const Settings& settings,
                                    std::uint64_t seed) {
    std::vector<DistanceQuery<N>> queries;
    for (int i = 0; i < settings.count; ++i) {
        RandomStream random(hashOf(seed, i));
        const double u = random.uniformOpenLow();
        queries.push_back({.origin = ray.origin,
                           .direction = ray.direction,
                           .tMax = ray.tMax,
                           .u = u,
                           .random = random,
                           .roulette = settings.roulette,
                           .absorptionToo = settings.absorptionToo,
                           .throughput = throughput});
    }
    TrackingCounters counters;
    trackDistance<N>(medium, queries, counters);
    return queries;
}

/// Mean throughput of the paths that end in each part, and of those that reach the end of the ray,
/// against quadrature: on many rays, each and all together.
template <int N>
void expectExact(const PlainMedium& plain, const Medium& medium, Spectrum<N> throughput,
                 const Settings& settings, const std::string& what) {
    Moments pooledEscape, pooledScatter;
    const std::vector<TestRay> rays = testRays(medium, 15, 5);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const TestRay& ray = rays[i];
        const auto queries = track<N>(medium, ray, throughput, settings, i);
        const auto check = [&](int part, const Vec3d& share, Moments& pooled) {
            for (int c = 0; c < N; ++c) {
                Moments m;
                for (const auto& q : queries) m.add(q.part == part ? q.throughput[c] : 0);
                const double expected = throughput[c] * share[c];
                if (expected > 0.02) expectMean(m, expected, 0.03, what);
                pooled.add(m.mean() - expected);
            }
        };
        check(-1, plain.transmittance(ray.origin, ray.direction, ray.tMax), pooledEscape);
        for (std::size_t part = 0; part < plain.parts().size() && !settings.absorptionToo; ++part)
            check(static_cast<int>(part),
                  plain.scattered(plain.parts()[part], ray.origin, ray.direction, ray.tMax),
                  pooledScatter);
    }
    expectMean(pooledEscape, 0, 0.006, what + ", escape");
    expectMean(pooledScatter, 0, 0.006, what + ", scattering");
}

TEST(Distance, EscapeAndScatteringAreExactInTheMean) {
    expectExact<1>(greyMedium(), greyMedium().medium(), Spectrum<1>(1), {}, "grey");
    expectExact<3>(greyMedium(), greyMedium().medium(), {1, 1, 1}, {}, "grey in three channels");
    expectExact<1>(hazyMedium(), hazyMedium().medium(), Spectrum<1>(1), {}, "hazy");
    expectExact<3>(chromaticMedium(), chromaticMedium().medium(), {1, 1, 1}, {}, "chromatic");
    expectExact<3>(tintedGlass(), tintedGlass().medium(), {1, 0.5, 0.25}, {}, "glass");
    expectExact<1>(greyMedium(), greyMedium().medium(), Spectrum<1>(1), {.absorptionToo = true},
                   "grey interactions");
    expectExact<3>(chromaticMedium(), chromaticMedium().medium(), {1, 1, 1},
                   {.absorptionToo = true}, "chromatic interactions");
}

TEST(Distance, MajorantsChangeNoMean) {
    for (double scale : {2.0, 8.0})
        for (int smallestLog2 : {1, 3, 6}) {
            expectExact<1>(hazyMedium(), hazyMedium().medium(scale, smallestLog2), Spectrum<1>(1),
                           {}, "hazy");
            expectExact<3>(chromaticMedium(), chromaticMedium().medium(scale, smallestLog2),
                           {1, 1, 1}, {}, "chromatic");
        }
}

TEST(Distance, RouletteChangesNoMean) {
    for (float threshold : {0.1f, 0.5f, 1.5f}) {
        const Settings settings{.roulette = threshold, .count = 8000};
        expectExact<1>(greyMedium(), greyMedium().medium(), Spectrum<1>(0.6f), settings, "grey");
        expectExact<3>(chromaticMedium(), chromaticMedium().medium(), {0.6f, 0.2f, 0.05f}, settings,
                       "chromatic");
        expectExact<3>(tintedGlass(), tintedGlass().medium(), {0.1f, 0.2f, 0.6f}, settings,
                       "glass");
    }
}

/// A slab that takes half of every channel at a collision, then two that scatter one channel each:
/// there a path's throughput rises, as it stands for the channels that it turned out to serve.
TEST(Distance, RouletteIsFairToThroughputThatFallsAndRises) {
    PlainGrid cube;
    cube.setTile({0, 0, 0}, 8, {1});
    const auto slab = [&](double x, Rgb absorption, Rgb scattering) {
        return PlainPart{
            .grid = cube,
            .worldFromIndex = Affine3d::translate({x, 0, 0}) * Affine3d::scale({0.125, 1, 1}),
            .absorption = absorption,
            .scattering = scattering};
    };
    const PlainMedium plain({slab(0, Rgb(1.5f), Rgb(0.0f)), slab(2, Rgb(0.0f), {3, 0.03f, 0.03f}),
                             slab(4, Rgb(0.0f), {0.03f, 3, 0.03f})});
    const Medium medium = plain.medium(2);
    const TestRay ray{{-1, 3.5, 3.5}, {1, 0, 0}, 10};
    for (float threshold : {0.2f, 0.5f, 1.0f}) {
        const auto queries =
            track<3>(medium, ray, {0.3f, 0.3f, 0.3f}, {.roulette = threshold, .count = 200000}, 1);
        for (int part = -1; part < 3; ++part) {
            const Vec3d share = part < 0
                                    ? plain.transmittance(ray.origin, ray.direction, ray.tMax)
                                    : plain.scattered(plain.parts()[static_cast<std::size_t>(part)],
                                                      ray.origin, ray.direction, ray.tMax);
            for (int c = 0; c < 3; ++c) {
                Moments m;
                for (const auto& q : queries) m.add(q.part == part ? q.throughput[c] : 0);
                expectMean(m, 0.3f * share[c], 0.001, "slabs");
            }
        }
    }
}

TEST(Distance, FlatMediaHaveNoNoiseInTheirWeights) {
    const PlainMedium plain({{.grid = {},
                              .box = {{0, 0, 0}, {1, 1, 1}},
                              .absorption = Rgb(1.0f),
                              .scattering = Rgb(3.0f)}});
    const TestRay ray{{-1, 0.5, 0.5}, {1, 0, 0}, infinity};
    Moments events;
    for (const auto& q : track<1>(plain.medium(), ray, Spectrum<1>(1), {.count = 20000}, 3)) {
        EXPECT_EQ(q.throughput[0], q.part < 0 ? 1 : 0.75f);
        events.add(q.part == 0);
    }
    expectMean(events, 1 - std::exp(-4.0), 0.01, "events");
}

TEST(Distance, AlbedoOneLosesNothingAndAlbedoZeroScattersNever) {
    PlainPart part{.grid = mixedGrid(1), .scattering = Rgb(0.3f)};
    for (const TestRay& ray : testRays(PlainMedium({part}).medium(), 10, 7)) {
        for (const auto& q : track<1>(PlainMedium({part}).medium(), ray, Spectrum<1>(1), {}, 4))
            ASSERT_EQ(q.throughput[0], 1);
        PlainPart black = part;
        black.albedo = PlainGrid(3, {0, 0, 0});
        for (const auto& q : track<3>(PlainMedium({black}).medium(), ray, {1, 1, 1}, {}, 5))
            ASSERT_EQ(q.part, -1);
    }
}

TEST(Distance, PartsAreChosenInProportionToScattering) {
    const Box3d box{{0, 0, 0}, {2, 2, 2}};
    const PlainMedium plain(
        {{.grid = {}, .box = box, .scattering = Rgb(1.0f), .g = 0.8},
         {.grid = {}, .box = box, .scattering = Rgb(3.0f), .g = -0.5},
         {.grid = {}, .box = box, .absorption = Rgb(1.0f), .scattering = Rgb(0.0f)}});
    const Medium medium = plain.medium();
    std::array<Moments, 3> chosen;
    for (const auto& q :
         track<1>(medium, {{0, 1, 1}, {1, 0, 0}, 2}, Spectrum<1>(1), {.count = 50000}, 6))
        for (int i = 0; i < 3; ++i)
            chosen[static_cast<std::size_t>(i)].add(q.part == i ? q.throughput[0] : 0);
    const double interacts = 1 - std::exp(-10.0);
    expectMean(chosen[0], interacts / 5, 0.002, "first");
    expectMean(chosen[1], interacts * 3 / 5, 0.003, "second");
    EXPECT_EQ(chosen[2].mean(), 0);
}

TEST(Distance, AnyOpticalDepthIsFiniteFastAndRight) {
    for (double depth : {1e-10, 1e-4, 88.0, 104.0, 1e4, 1e8})
        for (float albedo : {0.0f, 0.5f, 1.0f}) {
            PlainGrid grid;
            for (int x = 0; x < 8; ++x)
                grid.setLeaf({x * 8, 0, 0},
                             [&](Vec3i v, int) { return static_cast<float>(v.x % 3); });
            const auto sigma = static_cast<float>(depth / 64);
            const PlainMedium plain({{.grid = grid,
                                      .absorption = Rgb(sigma * (1 - albedo)),
                                      .scattering = Rgb(sigma * albedo)}});
            Moments weight;
            const TestRay ray{{-5, 3.5, 3.5}, {1, 0, 0}, infinity};
            for (const auto& q :
                 track<1>(plain.medium(), ray, Spectrum<1>(1), {.count = 2000}, 7)) {
                ASSERT_TRUE(q.throughput.isFinite() && q.throughput[0] >= 0 &&
                            q.throughput[0] <= 1);
                weight.add(q.throughput[0]);
            }
            const double expected =
                albedo + (1 - albedo) * plain.transmittance(ray.origin, ray.direction, 100).x;
            const double rare = depth < 1 ? 2 * depth : 0;  // too few to make an error of
            EXPECT_NEAR(weight.mean(), expected, 4 * weight.standardError() + 2e-7 + rare);
            EXPECT_LE(weight.standardError(), 0.01);
        }
}

TEST(Distance, AThousandPartsAdd) {
    std::vector<PlainPart> parts;
    for (int i = 0; i < 1000; ++i)
        parts.push_back({.grid = {},
                         .box = {{0.01 * i, -9, -9}, {5 + 0.01 * i, 9, 9}},
                         .absorption = Rgb(0.00005f),
                         .scattering = Rgb(0.00015f)});
    const PlainMedium plain(parts);
    const TestRay ray{{-1, 0, 0}, {1, 0, 0}, infinity};
    const double transmittance = std::exp(-1000 * 5 * 0.0002);
    Moments escaped, scattered;
    for (const auto& q : track<1>(plain.medium(), ray, Spectrum<1>(1), {}, 8)) {
        escaped.add(q.part < 0 ? q.throughput[0] : 0);
        scattered.add(q.part < 0 ? 0 : q.throughput[0]);
    }
    expectMean(escaped, transmittance, 0.01, "escaped");
    expectMean(scattered, 0.75 * (1 - transmittance), 0.01, "scattered");
}

TEST(Distance, WhereThereIsNothingThePathGoesOnUnchanged) {
    const TestRay ray{{0, 0, 0}, {1, 0, 0}, infinity};
    const Medium empty = PlainMedium({{.grid = PlainGrid()}}).medium();
    for (const Medium& medium : {Medium{}, empty})
        for (const auto& q :
             track<1>(medium, ray, Spectrum<1>(0.01f), {.roulette = 1, .count = 100}, 9)) {
            EXPECT_EQ(q.part, -1);
            EXPECT_EQ(q.t, infinity);
            EXPECT_EQ(q.throughput[0], 0.01f);
        }
}

TEST(Distance, AnAlbedoGridIsReadFarFromItsVoxels) {
    PlainGrid albedo(3, {0, 0, 0});
    albedo.setLeaf({0, 0, 0}, [](Vec3i, int) { return 1.0f; });
    const PlainMedium plain({{.grid = {},
                              .box = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}},
                              .scattering = Rgb(1e-5f),
                              .albedo = albedo,
                              .albedoWorldFromIndex = Affine3d::scale({1e-6, 1e-6, 1e-6})}});
    for (const auto& q :
         track<1>(plain.medium(), {{-9e5, 1, 1}, {1, 0, 0}, infinity}, Spectrum<1>(1), {}, 10))
        ASSERT_EQ(q.part, -1);  // black all the way
}

}  // namespace
}  // namespace woodcock::test
