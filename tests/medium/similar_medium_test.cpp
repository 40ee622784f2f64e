// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/similar_medium.h"

#include <gtest/gtest.h>

#include "tests/medium/media.h"
#include "tests/support/expect_error.h"
#include "tests/support/expect_mean.h"
#include "woodcock/medium/octaves.h"
#include "woodcock/medium/tracking.h"

namespace woodcock::test {

using namespace proof;

using namespace medium;
namespace {

/// Overlapping coloured parts, of which one has an albedo grid and scatters forwards: its
/// absorption stays what it is while its scattering falls, so extinction is in proportion to
/// neither grid.
PlainMedium withAlbedo(double g) {
    std::vector<PlainPart> parts = chromaticMedium().parts();
    parts[1].g = g;
    return PlainMedium(std::move(parts));
}

Vec3d similarSigmaS(const PlainMedium& plain, Vec3d world) {
    Vec3d sum;
    for (const PlainPart& p : plain.parts()) sum += plain.sigmaS(p, world) * (1 - p.g);
    return sum;
}
Vec3d similarSigmaT(const PlainMedium& plain, Vec3d world) {
    Vec3d sum = plain.sigmaT(world);
    for (const PlainPart& p : plain.parts()) sum += plain.sigmaS(p, world) * -p.g;
    return sum;
}

TEST(SimilarMedium, HasLessScatteringAndTheSameAbsorption) {
    for (const double g : {0.8, -0.5}) {
        const PlainMedium plain = withAlbedo(g);
        const Medium medium = plain.medium();
        const Medium similar = similarMedium(medium);
        for (const TestRay& ray : testRays(medium, 20, 1)) {
            const Vec3d p = ray.origin + ray.direction * (ray.tMax / 2);
            Rgb t, s;
            for (const MediumPart& part : similar.parts) {
                EXPECT_EQ(part.phase().value(1), PhaseFunction().value(1));
                t += part.sigmaT(p), s += part.sigmaS(p);
            }
            const Vec3d truthT = similarSigmaT(plain, p), truthS = similarSigmaS(plain, p);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(t[c], truthT[c], 1e-5 * (1 + truthT[c]));
                EXPECT_NEAR(s[c], truthS[c], 1e-5 * (1 + truthS[c]));
            }
        }
    }
}

/// Of any phase function, its mean cosine counts; of a table, that of each colour.
TEST(SimilarMedium, ReducesByTheMeanCosineOfAnyPhaseFunction) {
    MediumPart::Description d;
    d.box = {{0, 0, 0}, {1, 1, 1}};
    d.scattering = Rgb(2.0f);
    d.phase = MieDroplets(10);
    const auto reduced = [&] { return similarMedium({{MediumPart(d)}}).parts[0]; };
    EXPECT_NEAR(reduced().scattering()[0], 2 * (1 - MieDroplets(10).meanCosine()), 1e-6);
    d.phase = PhaseTable({{-1, 1}, {{1, 1}, {0, 1}, {1, 0}}}, true);  // mean cosines 0, 1/3, -1/3
    EXPECT_NEAR(reduced().scattering()[0], 2, 1e-6);
    EXPECT_NEAR(reduced().scattering()[1], 4 / 3.0, 1e-6);
    EXPECT_NEAR(reduced().scattering()[2], 8 / 3.0, 1e-6);
    d.albedo = std::make_shared<grid::Field>(
        mixedGrid(5, 3, {0.5f, 0.25f, 1}).field(grid::Storage::Float));
    expectError(ErrorKind::Usage, "similarity needs one loss for all colours", reduced);
}

/// Both walks through it, against the midpoint rule in fine steps.
TEST(SimilarMedium, IsTrackedExactlyInTheMean) {
    constexpr int steps = 3000, samples = 4000;
    for (const double g : {0.8, -0.5}) {
        const PlainMedium plain = withAlbedo(g);
        const Medium original = plain.medium(), medium = similarMedium(original);
        Moments pooledArrived, pooledScattered;
        const std::vector<TestRay> rays = testRays(original, 8, 4);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const TestRay& ray = rays[i];
            Vec3d depth, scattered;
            const double step = ray.tMax / steps;
            for (int k = 0; k < steps; ++k) {
                const Vec3d p = ray.origin + ray.direction * ((k + 0.5) * step);
                const Vec3d t = similarSigmaT(plain, p), s = similarSigmaS(plain, p);
                for (int c = 0; c < 3; ++c) {
                    scattered[c] += s[c] * step * std::exp(-depth[c] - t[c] * step / 2);
                    depth[c] += t[c] * step;
                }
            }
            Moments arrived, scatters;
            TrackingCounters counters;
            for (int k = 0; k < samples; ++k) {
                RandomStream random(hashOf(i, k));
                TransmittanceQuery<3> q{.origin = ray.origin,
                                        .direction = ray.direction,
                                        .tMax = ray.tMax,
                                        .random = random,
                                        .contribution = Rgb(1.0f)};
                trackTransmittance<3>(medium, {&q, 1}, counters);
                DistanceQuery<3> d{.origin = ray.origin,
                                   .direction = ray.direction,
                                   .tMax = ray.tMax,
                                   .u = random.uniformOpenLow(),
                                   .random = RandomStream(hashOf(i, k, 1)),
                                   .throughput = Rgb(1.0f)};
                trackDistance<3>(medium, {&d, 1}, counters);
                double missing = 0, excess = 0;
                for (int c = 0; c < 3; ++c) {
                    missing += double{q.contribution[c]} - std::exp(-depth[c]);
                    excess += (d.part >= 0 ? double{d.throughput[c]} : 0) - scattered[c];
                }
                arrived.add(missing), scatters.add(excess);
            }
            expectMean(arrived, 0, 0.02, "transmittance");
            expectMean(scatters, 0, 0.03, "scattered");
        }
    }
}

TEST(SimilarMedium, SharesFieldsAndBounds) {
    const Medium medium = chromaticMedium().medium();
    for (const Medium& other : {similarMedium(medium), octaveMedium(medium, 2)})
        for (std::size_t i = 0; i < medium.parts.size(); ++i) {
            EXPECT_EQ(other.parts[i].field(), medium.parts[i].field());
            EXPECT_EQ(&other.parts[i].majorants(), &medium.parts[i].majorants());
        }
}

TEST(OctaveMedium, OnlyAbsorbs) {
    const PlainMedium plain = chromaticMedium();
    const Medium medium = octaveMedium(plain.medium(), 2);
    for (const TestRay& ray : testRays(medium, 20, 2)) {
        const Vec3d p = ray.origin + ray.direction * (ray.tMax / 2);
        Rgb t;
        for (const MediumPart& part : medium.parts) {
            EXPECT_FALSE(part.scatters());
            t += part.sigmaT(p);
        }
        const Vec3d truth = plain.sigmaT(p) * 0.25;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(t[c], truth[c], 1e-5 * (1 + truth[c]));
    }
}

TEST(Octaves, AreDrawnInProportionToTheirAmounts) {
    for (const int n : {1, 2, 5, 16}) {
        double total = 0;
        for (int i = 0; i < n; ++i) total += octave::amount(i);
        EXPECT_DOUBLE_EQ(octave::total(n), total);
        double below = 0;
        for (int i = 0; i < n; ++i) {
            EXPECT_EQ(octave::draw(n, below + 1e-9), i);
            below += octave::amount(i) / total;
            EXPECT_EQ(octave::draw(n, below - 1e-9), i);
        }
    }
}

}  // namespace
}  // namespace woodcock::test
