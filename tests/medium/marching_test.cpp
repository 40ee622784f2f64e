// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/marching.h"

#include <gtest/gtest.h>

#include <complex>

#include "tests/medium/media.h"
#include "tests/support/expect_error.h"
#include "tests/support/expect_mean.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/medium/similar_medium.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::test {

using namespace medium;
using namespace proof;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int N>
std::vector<TransmittanceQuery<N>> marchAcross(const Medium& medium, const MarchSettings& settings,
                                               const TestRay& ray, int count, std::uint64_t seed,
                                               float roulette = 0,
                                               Spectrum<N> contribution = Spectrum<N>(1.0f)) {
    std::vector<TransmittanceQuery<N>> queries;
    for (int i = 0; i < count; ++i)
        queries.push_back({.origin = ray.origin,
                           .direction = ray.direction,
                           .tMax = ray.tMax,
                           .random = RandomStream(hashOf(seed, i)),
                           .roulette = roulette,
                           .contribution = contribution});
    TrackingCounters counters;
    marchTransmittance<N>(medium, settings, queries, counters);
    return queries;
}

template <int N>
std::vector<DistanceQuery<N>> marchInto(const Medium& medium, const MarchSettings& settings,
                                        const TestRay& ray, int count, std::uint64_t seed,
                                        float roulette = 0,
                                        Spectrum<N> throughput = Spectrum<N>(1.0f)) {
    std::vector<DistanceQuery<N>> queries;
    for (int i = 0; i < count; ++i) {
        RandomStream random(hashOf(seed, i));
        const double u = random.uniformOpenLow();
        queries.push_back({.origin = ray.origin,
                           .direction = ray.direction,
                           .tMax = ray.tMax,
                           .u = u,
                           .random = random,
                           .roulette = roulette,
                           .throughput = throughput});
    }
    TrackingCounters counters;
    marchDistance<N>(medium, settings, queries, counters);
    return queries;
}

Moments meanTransmittance(const Medium& medium, const MarchSettings& settings, const TestRay& ray,
                          int count, std::uint64_t seed) {
    Moments m;
    for (const auto& q : marchAcross<1>(medium, settings, ray, count, seed))
        m.add(q.contribution[0]);
    return m;
}

// ---- fields that are constant ------------------------------------------------------------------

PlainMedium constantMedium() {
    PlainGrid grid;
    grid.setTile({0, 0, 0}, 128, {0.3f});
    grid.setTile({128, 0, 0}, 128, {0.3f});
    return PlainMedium(
        {{.grid = grid, .absorption = {0.1f, 0.2f, 0}, .scattering = {0, 0.1f, 0.5f}},
         {.grid = {}, .box = {{-9, -9, -9}, {200, 200, 200}}, .scattering = Rgb(0.01f)}});
}

TEST(Marching, IsExactWhereTheFieldIsConstant) {
    const Medium medium = constantMedium().medium();
    const TestRay ray{{3, 4, 5}, normalize(Vec3d{2, 0.5, 0.25}), 100};
    const Vec3d expected = constantMedium().transmittance(ray.origin, ray.direction, ray.tMax);
    for (double step : {0.01, 0.5, 3.0, 1000.0})
        for (bool jackknife : {false, true})
            for (const auto& q : marchAcross<3>(medium, {step, jackknife}, ray, 10, 1))
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(q.contribution[c] / expected[c], 1, 1e-5);
}

TEST(Marching, FindsTheExponentialDistributionWhereTheFieldIsConstant) {
    const PlainMedium plain({{.grid = {},
                              .box = {{0, 0, 0}, {1, 1, 1}},
                              .absorption = Rgb(1.0f),
                              .scattering = Rgb(3.0f)}});
    for (double step : {0.01, 1000.0}) {
        constexpr int bins = 20, count = 50000;
        std::vector<double> counts(bins + 1), expected(bins + 1);
        for (int i = 0; i < bins; ++i)
            expected[static_cast<std::size_t>(i)] =
                count * (std::exp(-4.0 * i / bins) - std::exp(-4.0 * (i + 1) / bins));
        expected[bins] = count * std::exp(-4.0);
        for (const auto& q : marchInto<1>(plain.medium(), {step, true},
                                          {{-1, 0.5, 0.5}, {1, 0, 0}, infinity}, count, 2)) {
            ASSERT_EQ(q.throughput[0], q.part < 0 ? 1 : 0.75f);
            ++counts[q.part < 0 ? bins : static_cast<std::size_t>((q.t - 1) * bins)];
        }
        EXPECT_GT(chiSquareProbability(counts, expected), leastProbability);
    }
}

/// Fog that never ends, of another density in each channel.
TEST(Marching, BackgroundIsExact) {
    const PlainMedium plain({{.grid = PlainGrid(3, {0.5f, 0.25f, 0}),
                              .absorption = Rgb(0.1f),
                              .scattering = Rgb(0.3f)}});
    const Medium medium = plain.medium();
    for (const auto& q : marchAcross<3>(medium, {}, {{0, 0, 0}, {1, 0, 0}, 10}, 10, 1)) {
        EXPECT_NEAR(q.contribution[0], std::exp(-2.0), 1e-6);
        EXPECT_NEAR(q.contribution[1], std::exp(-1.0), 1e-6);
        EXPECT_EQ(q.contribution[2], 1);
    }
    std::array<Moments, 3> scattered;
    for (const auto& q : marchInto<3>(medium, {}, {{0, 0, 0}, {1, 0, 0}, infinity}, 50000, 2))
        for (int c = 0; c < 3; ++c)
            scattered[static_cast<std::size_t>(c)].add(q.part >= 0 ? q.throughput[c] : 0);
    expectMean(scattered[0], 0.75, 0.01, "dense");
    expectMean(scattered[1], 0.75, 0.01, "thin");
    EXPECT_EQ(scattered[2].mean(), 0);
}

// ---- the bias ----------------------------------------------------------------------------------

/// f rises from 0 by 1 a voxel over one cell of 8.
PlainMedium ramp(float slope) {
    PlainGrid grid;
    for (int i = 0; i < 27; ++i)
        grid.setLeaf(Vec3i{i % 3, i / 3 % 3, i / 9} * 8,
                     [](Vec3i v, int) { return static_cast<float>(v.x); });
    return PlainMedium({{.grid = grid, .scattering = Rgb(slope)}});
}
const TestRay upTheRamp{{8, 10.5, 10.5}, {1, 0, 0}, 8};

/// Each look-up is even between the step's ends: the mean of exp(-z x) of its depth, over that at
/// the middle, is sinh(z a) / (z a), with half of the depth's range a.
double rampBias(double slope, double step, bool jackknife) {
    const std::complex<double> z =
        jackknife ? std::complex<double>(0.5, -0.5) : std::complex<double>(1, 0);
    const std::complex<double> a = z * (slope * step * step / 2);
    const std::complex<double> mean = std::sinh(a) / a;
    return std::pow(jackknife ? std::norm(mean) : mean.real(), 8 / step) - 1;
}

TEST(Marching, BiasIsWhatTheVarianceOfTheDepthSays) {
    const float slope = 0.03f;  // of the 8 to 16 along the ray: depth 2.88
    const Medium medium = ramp(slope).medium();
    const double exact =
        std::exp(-exactOpticalDepth(medium, upTheRamp.origin, upTheRamp.direction, 0, 8)[0]);
    EXPECT_NEAR(exact, std::exp(-slope * 96), 1e-6);
    for (double step : {8.0, 4.0, 2.0, 1.0})
        for (bool jackknife : {false, true}) {
            SCOPED_TRACE(testing::Message() << step << (jackknife ? ", jackknife" : ", plain"));
            Moments relative;
            for (const auto& q : marchAcross<1>(medium, {step, jackknife}, upTheRamp, 200000, 3))
                relative.add(q.contribution[0] / exact - 1);
            expectMean(relative, rampBias(slope, step, jackknife), 0.002, "ramp");
        }
    // Third order, and far above what the jackknife leaves: which means something.
    EXPECT_NEAR(rampBias(slope, 2, false) / rampBias(slope, 1, false), 8, 0.2);
    EXPECT_GT(rampBias(slope, 8, false), 0.15);
    EXPECT_LT(std::abs(rampBias(slope, 8, true)), 0.005);
}

/// Rough noise, gaps, tiles: against the exact integral, over many rays.
TEST(Marching, BiasFallsWithTheStepAndTheJackknifes) {
    const Medium medium = PlainMedium({{.grid = mixedGrid(1), .scattering = Rgb(1.5f)}}).medium();
    const auto bias = [&](double step, bool jackknife) {
        Moments pooled;
        const std::vector<TestRay> rays = testRays(medium, 60, 4);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const TestRay& ray = rays[i];
            const double exact =
                std::exp(-exactOpticalDepth(medium, ray.origin, ray.direction, 0, ray.tMax)[0]);
            if (exact < 0.05 || exact > 0.95) continue;
            for (const auto& q : marchAcross<1>(medium, {step, jackknife}, ray, 4000, i))
                pooled.add(q.contribution[0] / exact - 1);
        }
        EXPECT_GT(pooled.count(), 20000u);
        return pooled;
    };
    const Moments coarse = bias(4, false), middle = bias(2, false), fine = bias(1, false);
    EXPECT_GT(fine.mean(), 8 * fine.standardError());
    EXPECT_LT(middle.mean(), coarse.mean() / 3);  // rough where steps are coarse: second order,
    EXPECT_LT(fine.mean(), middle.mean() / 3);    // on the way to the third of smooth fields
    for (const auto& [step, plain] : {std::pair{4.0, coarse}, {2.0, middle}}) {
        const Moments jackknife = bias(step, true);
        EXPECT_LT(std::abs(jackknife.mean()) + 4 * jackknife.standardError(), plain.mean() / 5);
    }
}

TEST(Marching, ScatteringIsWhereTheFieldIs) {
    const float slope = 0.03f;
    const PlainMedium plain = ramp(slope);
    const auto meanPlace = [&](double step) {
        Moments place;
        for (const auto& q : marchInto<1>(plain.medium(), {step, true}, upTheRamp, 200000, 5))
            if (q.part >= 0) place.add(q.t);
        return place;
    };
    const auto density = [&](double t) {
        return slope * (8 + t) * std::exp(-slope * (8 * t + t * t / 2));
    };
    const double expected = integrate(0, 8, 16, [&](double t) { return t * density(t); }) /
                            integrate(0, 8, 16, density);
    expectMean(meanPlace(1), expected, 0.006, "fine");
    expectMean(meanPlace(4), expected, 0.006, "coarse");
}

// ---- the same means as tracking, where steps are fine ------------------------------------------

template <int N>
void expectExact(const PlainMedium& plain, Spectrum<N> throughput, float roulette,
                 const std::string& what) {
    const Medium medium = plain.medium();
    const MarchSettings fine{0.25, true};
    Moments pooledEscape, pooledScatter, pooledAcross;
    const std::vector<TestRay> rays = testRays(medium, 8, 5);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const TestRay& ray = rays[i];
        const auto events = marchInto<N>(medium, fine, ray, 2000, i, roulette, throughput);
        double scatterSurplus = 0, escapeSurplus = 0, acrossSurplus = 0;
        const auto check = [&](int part, const Vec3d& share, double& surplus) {
            for (int c = 0; c < N; ++c) {
                Moments m;
                for (const auto& q : events) m.add(q.part == part ? q.throughput[c] : 0);
                const double expected = throughput[c] * share[c];
                if (expected > 0.02) expectMean(m, expected, 0.03, what);
                surplus += m.mean() - expected;
            }
        };
        const Vec3d through = plain.transmittance(ray.origin, ray.direction, ray.tMax);
        check(-1, through, escapeSurplus);
        for (std::size_t part = 0; part < plain.parts().size(); ++part)
            check(static_cast<int>(part),
                  plain.scattered(plain.parts()[part], ray.origin, ray.direction, ray.tMax),
                  scatterSurplus);
        const auto across = marchAcross<N>(medium, fine, ray, 2000, i, roulette, throughput);
        for (int c = 0; c < N; ++c) {
            Moments m;
            for (const auto& q : across) m.add(q.contribution[c]);
            if (through[c] > 0.02) expectMean(m, throughput[c] * through[c], 0.02, what);
            acrossSurplus += m.mean() - throughput[c] * through[c];
        }
        // Channels share their random numbers: only rays are independent.
        pooledEscape.add(escapeSurplus), pooledScatter.add(scatterSurplus);
        pooledAcross.add(acrossSurplus);
    }
    expectMean(pooledEscape, 0, 0.01, what + ", escape");
    expectMean(pooledScatter, 0, 0.01, what + ", scattering");
    expectMean(pooledAcross, 0, 0.01, what + ", across");
}

TEST(Marching, FineStepsFindTheMeansOfQuadrature) {
    expectExact<1>(greyMedium(), Spectrum<1>(1), 0, "grey");
    expectExact<1>(hazyMedium(), Spectrum<1>(1), 0, "hazy");
    expectExact<3>(chromaticMedium(), {1, 1, 1}, 0, "chromatic");
    expectExact<3>(chromaticMedium(), {1, 0.1f, 0}, 0, "chromatic, uneven");
    expectExact<3>(tintedGlass(), {1, 0.5f, 0.25f}, 0, "glass");
}

TEST(Marching, RouletteChangesNoMean) {
    for (float threshold : {0.1f, 1.5f}) {
        expectExact<1>(greyMedium(), Spectrum<1>(0.6f), threshold, "grey");
        expectExact<3>(chromaticMedium(), {0.6f, 0.2f, 0.05f}, threshold, "chromatic");
    }
}

TEST(Marching, PartsAreChosenInProportionToScattering) {
    const Box3d box{{0, 0, 0}, {2, 2, 2}};
    const Medium medium =
        PlainMedium({{.grid = {}, .box = box, .scattering = Rgb(1.0f), .g = 0.8},
                     {.grid = {}, .box = box, .scattering = Rgb(3.0f), .g = -0.5},
                     {.grid = {}, .box = box, .absorption = Rgb(1.0f), .scattering = Rgb(0.0f)}})
            .medium();
    std::array<Moments, 3> chosen;
    for (const auto& q : marchInto<1>(medium, {}, {{0, 1, 1}, {1, 0, 0}, 2}, 50000, 6))
        for (int i = 0; i < 3; ++i)
            chosen[static_cast<std::size_t>(i)].add(q.part == i ? q.throughput[0] : 0);
    const double interacts = 1 - std::exp(-10.0);
    expectMean(chosen[0], interacts / 5, 0.002, "first");
    expectMean(chosen[1], interacts * 3 / 5, 0.003, "second");
    EXPECT_EQ(chosen[2].mean(), 0);
}

TEST(Marching, AlbedoOneLosesNothing) {
    const Medium medium = PlainMedium({{.grid = mixedGrid(1), .scattering = Rgb(0.3f)}}).medium();
    for (const TestRay& ray : testRays(medium, 10, 7))
        for (const auto& q : marchInto<1>(medium, {3, true}, ray, 100, 4))
            ASSERT_EQ(q.throughput[0], 1);
}

// ---- extremes ----------------------------------------------------------------------------------

TEST(Marching, AnyScaleIsFiniteAndRight) {
    for (double scale : {1e-8, 1e-4, 1.0, 1e2, 1e5, 1e8}) {
        PlainGrid grid;
        for (int x = 0; x < 8; ++x)
            grid.setLeaf({x * 8, 0, 0}, [](Vec3i v, int) { return static_cast<float>(v.x % 3); });
        const PlainMedium plain({{.grid = grid, .scattering = Rgb(static_cast<float>(scale))}});
        const TestRay ray{{-5, 3.5, 3.5}, {1, 0, 0}, infinity};
        const double expected = plain.transmittance(ray.origin, ray.direction, 100).x;
        for (bool jackknife : {false, true}) {
            const Moments m = meanTransmittance(plain.medium(), {0.25, jackknife}, ray, 2000, 2);
            ASSERT_TRUE(std::isfinite(m.mean()));
            EXPECT_NEAR(m.mean(), expected, 4 * m.standardError() + 2e-7) << scale;
            Moments escaped;
            for (const auto& q : marchInto<1>(plain.medium(), {0.25, jackknife}, ray, 2000, 3)) {
                ASSERT_TRUE(q.throughput[0] == 1 && (q.part < 0 || std::isfinite(q.t)));
                escaped.add(q.part < 0);
            }
            const double rare = scale < 1e-3 ? 200 * scale : 0;  // too few to make an error of
            EXPECT_NEAR(escaped.mean(), expected, 4 * escaped.standardError() + 2e-7 + rare);
        }
    }
}

TEST(Marching, StepsAreSpentOnlyWhereTheFieldVaries) {
    PlainGrid grid;  // a million voxels wide, ten of them active
    for (int i = 0; i < 10; ++i)
        grid.setLeaf({i * 100000, 0, 0}, [&](Vec3i v, int) {
            return v == Vec3i{i * 100000 + 4, 4, 4} ? 1.0f : 0.0f;
        });
    const PlainMedium plain({{.grid = grid, .scattering = Rgb(0.1f)}});
    const Medium medium = plain.medium();
    for (double step : {0.1, 1.0, 1e6}) {
        prepareMarch(medium, {step, true});
        std::vector<TransmittanceQuery<1>> query{{.origin = {-5, 4, 4},
                                                  .direction = {1, 0, 0},
                                                  .tMax = infinity,
                                                  .random = RandomStream(1),
                                                  .contribution = Spectrum<1>(1.0f)}};
        TrackingCounters counters;
        marchTransmittance<1>(medium, {step, true}, query, counters);
        EXPECT_LE(counters.collisions, 20 * 2 * (8 / step + 1));
        EXPECT_GT(counters.collisions, 0u);
        if (step < 1) {
            EXPECT_NEAR(query[0].contribution[0], std::exp(-1.0), 0.01);
        }
    }
}

TEST(Marching, RefusesStepsThatWouldNeedMillions) {
    const Medium medium = PlainMedium({{.grid = mixedGrid(1)}}).medium();
    expectError(ErrorKind::Usage, "march_step is 1e-06 voxels: a ray through", [&] {
        prepareMarch(medium, {1e-6, true});
    });
    for (double step : {0.0, -1.0, infinity, std::nan("")})
        expectError(ErrorKind::Usage, "expected a number above 0", [&] {
            prepareMarch(medium, {step, true});
        });
    EXPECT_NO_THROW(prepareMarch(medium, {1e-3, true}));
    EXPECT_NO_THROW(prepareMarch(Medium{}, {1e-9, true}));
    EXPECT_NO_THROW(prepareMarch(constantMedium().medium(), {0.01, true}));
}

TEST(Marching, RefusesStandInsWhoseExtinctionFollowsTheAlbedo) {
    const Medium medium = chromaticMedium().medium();
    EXPECT_NO_THROW(prepareMarch(medium, {1, true}));
    expectError(ErrorKind::Usage, "march_step cannot be used together with similarity or octaves",
                [&] {
                    prepareMarch(similarMedium(medium), {1, true});
                });
}

TEST(Marching, RaysOfEveryKindEnd) {
    const Medium medium = greyMedium().medium();
    const Box3d box = medium.worldBounds();
    const Vec3d c = box.centre();
    for (double step : {1e-2, 0.7, 1e3})
        for (const Vec3d direction : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1},
                                      normalize(Vec3d{1, 1, 1}), normalize(Vec3d{1, 1e-300, 0})})
            for (double tMax : {0.0, 1e-12, 3.0, infinity}) {
                const TestRay ray{
                    {std::floor(c.x), std::floor(c.y), std::floor(c.z)}, direction, tMax};
                for (const auto& q : marchAcross<1>(medium, {step, true}, ray, 3, 1)) {
                    ASSERT_TRUE(q.contribution[0] >= 0 && q.contribution[0] <= 1);
                    if (tMax == 0) {
                        EXPECT_EQ(q.contribution[0], 1);
                    }
                }
                for (const auto& q : marchInto<1>(medium, {step, true}, ray, 3, 2))
                    ASSERT_TRUE(q.t <= tMax && (tMax > 0 || q.part < 0));
            }
}

TEST(Marching, WhereThereIsNothingTheRayGoesOnUnchanged) {
    const TestRay ray{{0, 0, 0}, {1, 0, 0}, infinity};
    const Medium empty = PlainMedium({{.grid = PlainGrid()}}).medium();
    for (const Medium& medium : {Medium{}, empty}) {
        for (const auto& q : marchAcross<3>(medium, {}, ray, 10, 1, 0, {0.5f, 0, 1e-30f}))
            EXPECT_EQ(q.contribution, Spectrum<3>(0.5f, 0, 1e-30f));
        for (const auto& q : marchInto<1>(medium, {}, ray, 10, 1, 1, Spectrum<1>(0.01f))) {
            EXPECT_EQ(q.part, -1);
            EXPECT_EQ(q.t, infinity);
            EXPECT_EQ(q.throughput[0], 0.01f);
        }
    }
}

}  // namespace
}  // namespace woodcock::test
