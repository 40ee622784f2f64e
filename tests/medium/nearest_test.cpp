// SPDX-License-Identifier: Apache-2.0
// Nearest look-up: every voxel fills the unit cube around its index position, so the medium is
// constant between planes halfway between voxels, and its integrals are sums.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/medium/media.h"
#include "tests/support/expect_mean.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/medium/tracking.h"

namespace woodcock::test {

using namespace proof;

using namespace grid;
using namespace medium;
namespace {

/// The renderer's medium with nearest look-ups.
Medium nearest(const PlainMedium& plain, int smallestLog2 = 1) {
    Medium medium;
    for (const MediumPart& part : plain.medium(1, smallestLog2).parts) {
        MediumPart::Description d = part.description();
        for (std::shared_ptr<const Field>* field : {&d.field, &d.albedo})
            if (*field) std::const_pointer_cast<Field>(*field)->setLookup(Lookup::Nearest);
        medium.parts.emplace_back(std::move(d));
    }
    return medium;
}

/// Brute force.
Vec3d opticalDepth(const PlainMedium& plain, const TestRay& ray) {
    Vec3d depth;
    for (const PlainPart& part : plain.parts()) {
        const Affine3d indexFromWorld = part.worldFromIndex.inverse();
        const Vec3d o = indexFromWorld.point(ray.origin), d = indexFromWorld.vector(ray.direction);
        std::vector<double> t{0, ray.tMax};
        for (int axis = 0; axis < 3; ++axis)
            for (int k = -80; k <= 80; ++k) {
                const double at = (k + 0.5 - o[axis]) / d[axis];
                if (at > 0 && at < ray.tMax) t.push_back(at);
            }
        std::sort(t.begin(), t.end());
        for (std::size_t i = 0; i + 1 < t.size(); ++i) {
            const Vec3d p = o + d * ((t[i] + t[i + 1]) / 2);
            const Vec3i voxel{static_cast<int>(std::floor(p.x + 0.5)),
                              static_cast<int>(std::floor(p.y + 0.5)),
                              static_cast<int>(std::floor(p.z + 0.5))};
            for (int c = 0; c < 3; ++c)
                depth[c] += (t[i + 1] - t[i]) * (double{part.absorption[c]} + part.scattering[c]) *
                            part.grid->voxel(voxel, part.grid->channels() == 1 ? 0 : c);
        }
    }
    return depth;
}

std::vector<PlainMedium> media() {
    return {greyMedium(), tintedGlass(),
            PlainMedium({{.grid = mixedGrid(2, 1, {0.05f}),
                          .worldFromIndex = awkwardTransform(),
                          .scattering = Rgb(0.2f)},
                         {.grid = mixedGrid(4, 3, haze),
                          .absorption = {0, 0.1f, 0.2f},
                          .scattering = {0.1f, 0.2f, 0.3f},
                          .albedo = mixedGrid(5, 3, {0.5f, 0.25f, 1})}})};
}

TEST(Nearest, ReadsTheVoxelNextToThePoint) {
    for (const PlainGrid& grid : {mixedGrid(1), mixedGrid(4, 3, haze)}) {
        Field field = grid.field();
        field.setLookup(Lookup::Nearest);
        EXPECT_EQ(field.lookup(), Lookup::Nearest);
        RandomStream random(1);
        for (int i = 0; i < 3000; ++i) {
            const Vec3d p = Vec3d{random.uniform(), random.uniform(), random.uniform()} * 44 -
                            Vec3d{22, 22, 22};
            const Vec3i v{static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y)),
                          static_cast<int>(std::lround(p.z))};
            const std::uint64_t bits = random.bits();
            for (int c = 0; c < grid.channels(); ++c) {
                ASSERT_EQ(field.trilinear(p, c), grid.voxel(v, c));
                ASSERT_EQ(field.stochastic(p, bits, c), grid.voxel(v, c));
            }
        }
        field.setLookup(Lookup::Trilinear);
        ASSERT_EQ(field.trilinear({0.5, 0.25, 3.5}), grid.field().trilinear({0.5, 0.25, 3.5}));
        ASSERT_EQ(field.stochastic({0.5, 0.25, 3.5}, 12345),
                  grid.field().stochastic({0.5, 0.25, 3.5}, 12345));
    }
}

TEST(Nearest, AVoxelFillsTheCubeAroundItsPosition) {
    PlainGrid grid;
    grid.setLeaf({0, 0, 0}, [](Vec3i v, int) { return v == Vec3i{7, 3, 0} ? 1.0f : 0.0f; });
    const Medium medium = nearest(PlainMedium({{.grid = grid}}));
    for (int i = 0; i < 3; ++i) {
        Vec3d origin{7, 3, 0}, direction;
        origin[i] -= 5, direction[i] = 1;
        const Box3d& box = medium.parts[0].support();
        EXPECT_LE(box.lower[i], origin[i] + 4.5);
        EXPECT_GE(box.upper[i], origin[i] + 5.5);
        const auto depth = [&](double side, double t0, double t1) {
            Vec3d beside = origin;
            beside[(i + 1) % 3] += side;
            return exactOpticalDepth(medium, beside, direction, t0, t1)[0];
        };
        EXPECT_NEAR(depth(0.2, 0, 10), 1, 1e-6);
        EXPECT_NEAR(depth(0.499, 0, 10), 1, 1e-6);
        EXPECT_NEAR(depth(-0.499, 4.5, 5.5), 1, 1e-6);
        EXPECT_EQ(depth(0.501, 0, 10), 0);
        EXPECT_EQ(depth(-0.501, 0, 10), 0);
        EXPECT_NEAR(depth(0, 0, 4.75), 0.25, 1e-6);
    }
}

TEST(Nearest, ExactOpticalDepthIsThePiecewiseConstantIntegral) {
    for (const PlainMedium& plain : media()) {
        const Medium medium = nearest(plain);
        int deep = 0;
        for (const TestRay& ray : testRays(medium, 100, 3)) {
            const Vec3d expected = opticalDepth(plain, ray);
            const Rgb depth = exactOpticalDepth(medium, ray.origin, ray.direction, 0, ray.tMax);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(depth[c], expected[c], 1e-6 * (1 + expected[c]));
            deep += expected.x > 0.5;
        }
        EXPECT_GT(deep, 10);
    }
}

/// All that passes, by both walks: weights of what absorbs, and chances of what scatters.
TEST(Nearest, TransmittanceIsThatOfThePiecewiseConstantIntegral) {
    const std::vector<PlainMedium> all = media();
    for (std::size_t m = 0; m < all.size(); ++m) {
        const Medium medium = nearest(all[m], m == 1 ? 4 : 1);
        Moments shadows, distances;
        const std::vector<TestRay> rays = testRays(medium, 20, 4);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const TestRay& ray = rays[i];
            constexpr std::size_t n = 3000;
            std::vector<TransmittanceQuery<3>> across;
            std::vector<DistanceQuery<3>> along;
            for (std::size_t k = 0; k < n; ++k) {
                RandomStream random(hashOf(m, i, k));
                across.push_back({.origin = ray.origin,
                                  .direction = ray.direction,
                                  .tMax = ray.tMax,
                                  .random = random,
                                  .contribution = Spectrum<3>(1)});
                const double u = random.uniformOpenLow();
                along.push_back({.origin = ray.origin,
                                 .direction = ray.direction,
                                 .tMax = ray.tMax,
                                 .u = u,
                                 .random = random,
                                 .throughput = Spectrum<3>(1)});
            }
            TrackingCounters counters;
            trackTransmittance<3>(medium, across, counters);
            trackDistance<3>(medium, along, counters);
            const Vec3d depth = opticalDepth(all[m], ray);
            for (int c = 0; c < 3; ++c) {
                Moments arrived, passed;
                for (const auto& q : across) arrived.add(q.contribution[c]);
                for (const auto& q : along) passed.add(q.part < 0 ? q.throughput[c] : 0);
                const double exact = std::exp(-depth[c]);
                if (exact > 0.02) {
                    expectMean(arrived, exact, 0.02, "shadow walk");
                    expectMean(passed, exact, 0.03, "distance walk");
                }
                shadows.add(arrived.mean() - exact), distances.add(passed.mean() - exact);
            }
        }
        expectMean(shadows, 0, 0.003, "shadow walk, all rays");
        expectMean(distances, 0, 0.004, "distance walk, all rays");
    }
}

/// Rays past a voxel a million mean free paths deep, through cells cut on the way: their bounds
/// are those of what nearest look-ups read, or nothing would pass.
TEST(Nearest, DeepCellsAreCutBetweenVoxels) {
    constexpr float thin = 5e-8f, extinction = 1e6f;
    for (int channels : {1, 3}) {
        PlainGrid grid(channels);
        for (int i = 0; i < 8; ++i)
            grid.setLeaf({8 * (i & 1), 8 * (i >> 1 & 1), 8 * (i >> 2)}, [&](Vec3i v, int) {
                return v == Vec3i{4, 3, 3} ? 1.0f : thin;
            });
        const Medium medium = nearest(
            PlainMedium({{.grid = grid, .absorption = Rgb(extinction), .scattering = Rgb(0.0f)}}),
            3);
        for (const Vec3d& origin : {Vec3d{0, 3.49, 3.51}, {0, 2.49, 3}, {0, 3.4, 3.6}}) {
            Moments passed;
            TrackingCounters counters;
            constexpr int n = 4000;
            for (int i = 0; i < n; ++i) {
                TransmittanceQuery<3> q{.origin = origin,
                                        .direction = {1, 0, 0},
                                        .tMax = 8,
                                        .random = RandomStream(hashOf(11, i)),
                                        .contribution = Spectrum<3>(1)};
                trackTransmittance<3>(medium, {&q, 1}, counters);
                passed.add(q.contribution[1]);
            }
            expectMean(passed, std::exp(-8.0 * thin * extinction), 0.005, "past the voxel");
            EXPECT_LT(static_cast<double>(counters.collisions) / n, 100);
        }
    }
}

}  // namespace
}  // namespace woodcock::test
