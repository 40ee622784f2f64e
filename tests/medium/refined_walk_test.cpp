// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_mean.h"
#include "woodcock/medium/refined_walk.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/proof/support/plain_medium.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::test {

using namespace grid;
using namespace medium;
using namespace proof;

namespace {

/// Zero but for single voxels of value 1 in the middle of a leaf.
PlainGrid spikes(int channels = 1) {
    PlainGrid grid(channels);
    grid.setLeaf({0, 0, 0}, [](Vec3i v, int c) {
        return v == Vec3i{3, 3, 3} || v == Vec3i{5, 4 - c % 2, 3} ? 1.0f : 0.0f;
    });
    return grid;
}

/// Through the foot of the spikes, their top, their sides; along axes, planes and edges.
std::vector<TestRay> spikeRays() {
    const double infinity = std::numeric_limits<double>::infinity();
    return {{{-5, 3, 3}, {1, 0, 0}, infinity},
            {{-5, 3.4, 2.7}, {1, 0, 0}, infinity},
            {{9, 3.999, 3.999}, {-1, 0, 0}, infinity},
            {{3, 3, 20}, {0, 0, -1}, infinity},
            {{2.0001, 3, -7}, {0, 0, 1}, infinity},
            {{0, 0, 0}, normalize(Vec3d{1, 1, 1}), infinity},
            {{3.1, 3.2, 2.9}, normalize(Vec3d{-0.3, 0.2, 0.9}), infinity},
            {{10, 7, 5}, normalize(Vec3d{-1, -0.61, -0.34}), infinity}};
}

/// A cell that is not worth cutting goes on with its bounds, from the collision only where that was
/// told: the control of what lies behind would be lost.
TEST(RefinedWalk, ShallowCellsKeepTheirBounds) {
    const Medium medium = PlainMedium({{.grid = mixedGrid(1), .scattering = Rgb(0.1f)}}).medium();
    const MediumPart& part = medium.parts[0];
    int segments = 0;
    for (const TestRay& r : testRays(medium, 20, 1)) {
        const IndexRay ray = part.indexRay(r.origin, r.direction);
        RefinedWalk walk(part, ray, r.tMax);
        for (Segment s{0, 0, {}}; walk.next(part, ray, s); ++segments) {
            const Segment whole = s;
            for (int i = 1; i <= 20; ++i) {
                const double t = whole.t0 + (whole.t1 - whole.t0) * i / 21, start = s.t0;
                const bool begunAnew = walk.collided(part, ray, t, s);
                EXPECT_EQ(s.t0, begunAnew ? t : start);
                EXPECT_EQ(s.t1, whole.t1);
                EXPECT_EQ(s.range, whole.range);
                EXPECT_FALSE(walk.tight());
            }
        }
    }
    EXPECT_GT(segments, 20);
}

/// Every piece joins the one before, lies in the cell, and bounds what is inside.
TEST(RefinedWalk, PiecesAreContiguousAndBounding) {
    for (int channels : {1, 3}) {
        const PlainGrid grid = spikes(channels);
        const Medium medium = PlainMedium({{.grid = grid, .scattering = Rgb(1e12f)}}).medium(1, 3);
        const MediumPart& part = medium.parts[0];
        int cuts = 0;
        for (const TestRay& r : spikeRays()) {
            const IndexRay ray = part.indexRay(r.origin, r.direction);
            RefinedWalk walk(part, ray, r.tMax);
            PartWalk coarse(part, ray, r.tMax);
            Segment s{0, 0, {}}, cell{0, 0, {}};
            double end = -1;
            for (int steps = 0; walk.next(part, ray, s); ++steps) {
                ASSERT_LT(steps, 2000);
                while (cell.t1 <= s.t0) ASSERT_TRUE(coarse.next(cell));
                for (int i = 0; i < 20; ++i) {  // collide just inside until it is cut
                    const double t = s.t0 + (s.t1 - s.t0) * 1e-3;
                    if (!walk.collided(part, ray, t, s)) continue;
                    EXPECT_EQ(s.t0, t);
                    end = t, ++cuts;
                    break;
                }
                if (end >= 0) {
                    EXPECT_EQ(s.t0, end);
                }
                EXPECT_LE(s.t1, cell.t1);
                EXPECT_GT(s.t1, s.t0);
                EXPECT_LE(s.range.max, cell.range.max * 1.001f);
                for (double u : {0.0, 1e-9, 0.01, 0.3, 0.5, 0.8, 1.0}) {
                    const Vec3d p = ray.at(s.t0 + u * (s.t1 - s.t0));
                    for (int c = 0; c < channels; ++c) {
                        EXPECT_LE(grid.trilinear(p, c), s.range.max);
                        EXPECT_GE(grid.trilinear(p, c), s.range.min);
                    }
                }
                end = s.t1;
            }
        }
        EXPECT_GE(cuts, 5);
    }
}

/// Depth D across one voxel: the walk reaches the foot of a linear ramp with density D x, so it
/// ends where D x^2 / 2 is an exponential variate. The bounds of the voxels alone would take the
/// root of D null collisions for that.
TEST(RefinedWalk, DeepRampsCostFewCollisions) {
    for (double depth : {1e2, 1e6, 1e12, 1e18}) {
        PlainGrid grid;
        grid.setLeaf({0, 0, 0}, [](Vec3i v, int) { return v.x >= 4 ? 1.0f : 0.0f; });
        const Medium medium =
            PlainMedium({{.grid = grid, .scattering = Rgb(static_cast<float>(depth))}})
                .medium(1, 3);
        constexpr int n = 20000;
        std::vector<DistanceQuery<1>> queries;
        for (int i = 0; i < n; ++i) {
            RandomStream random(hashOf(7, i));
            const double u = random.uniformOpenLow();
            queries.push_back({.origin = {2, 3.5, 3.5},
                               .direction = {1, 0, 0},
                               .tMax = 1e3,
                               .u = u,
                               .random = random,
                               .throughput = Spectrum<1>(1)});
        }
        TrackingCounters counters;
        trackDistance<1>(medium, queries, counters);
        EXPECT_LT(static_cast<double>(counters.collisions) / n, 40) << depth;
        EXPECT_LT(static_cast<double>(counters.segments) / n, 80) << depth;
        // Means of the optical depth (1) and of its square (2), both of variance known exactly.
        Moments first, second;
        for (const DistanceQuery<1>& q : queries) {
            ASSERT_EQ(q.part, 0);
            const double x = q.t - 1, tau = depth * x * x / 2;
            if (depth == 1e2 && x > 0.99) continue;  // the plateau; e^-50 gets there
            first.add(tau), second.add(tau * tau);
        }
        expectMean(first, 1, 0.01, fmt::format("optical depth at depth {}", depth));
        expectMean(second, 2, 0.05, fmt::format("its square at depth {}", depth));
    }
}

/// The transmittance of a ray across the foot of a spike, where the voxels' bounds allow a depth of
/// millions: depth = D int (1 - |x|) b c dx = D b c for a ray at the edge (b, c) of the spike.
TEST(RefinedWalk, TransmittanceAcrossTheFootOfADeepSpike) {
    for (double depth : {1e4, 1e8, 1e12}) {
        PlainGrid grid;
        grid.setLeaf({0, 0, 0}, [](Vec3i v, int) { return v == Vec3i{3, 3, 3} ? 1.0f : 0.0f; });
        const Medium medium = PlainMedium({{.grid = grid,
                                            .absorption = Rgb(static_cast<float>(depth)),
                                            .scattering = Rgb(0.0f)}})
                                  .medium(1, 3);
        const double b = std::sqrt(0.5 / depth);  // an optical depth of one half
        constexpr int n = 4000;
        std::vector<TransmittanceQuery<1>> queries;
        for (int i = 0; i < n; ++i)
            queries.push_back({.origin = {-2, 4 - b, 4 - b},
                               .direction = {1, 0, 0},
                               .tMax = 1e3,
                               .random = RandomStream(hashOf(9, i)),
                               .contribution = Spectrum<1>(1)});
        TrackingCounters counters;
        trackTransmittance<1>(medium, queries, counters);
        EXPECT_LT(static_cast<double>(counters.collisions) / n, 100) << depth;
        Moments m;
        for (const auto& q : queries) m.add(q.contribution[0]);
        expectMean(m, std::exp(-0.5), 0.01, fmt::format("depth {}", depth));
    }
}

/// Cells that are not worth cutting keep their lower bound's part of the way so far.
TEST(RefinedWalk, ManyCollisionsInAShallowCellLoseNothing) {
    PlainGrid grid(1, {0.1f});
    grid.setLeaf({0, 0, 0}, [](Vec3i v, int) { return (v.x + v.y + v.z) % 2 ? 1.0f : 0.1f; });
    const PlainMedium plain({{.grid = grid, .absorption = Rgb(1), .scattering = Rgb(0.0f)}});
    const Medium medium = plain.medium(1, 3);
    const TestRay ray{{0.2, 3.3, 4.1}, {1, 0, 0}, 6.5};
    constexpr int n = 200000;
    std::vector<TransmittanceQuery<1>> queries;
    for (int i = 0; i < n; ++i)
        queries.push_back({.origin = ray.origin,
                           .direction = ray.direction,
                           .tMax = ray.tMax,
                           .random = RandomStream(hashOf(21, i)),
                           .roulette = 1e-9f,
                           .contribution = Spectrum<1>(1)});
    TrackingCounters counters;
    trackTransmittance<1>(medium, queries, counters);
    EXPECT_GT(counters.collisions, 10 * n);  // effort: it gets to the eighth
    Moments m;
    for (const auto& q : queries) m.add(q.contribution[0]);
    const double exact = plain.transmittance(ray.origin, ray.direction, ray.tMax).x;
    expectMean(m, exact, 5e-3 * exact, "transmittance");
}

/// Two channels whose product of value and coefficient is 1, one that is deep: it dies at once and
/// then sets no pace; and values alone, 1e12 in one channel, set none.
TEST(RefinedWalk, DeadChannelsAndLargeValuesSetNoPace) {
    const auto pattern = [](Vec3i v) {
        return static_cast<float>(1 + (v.x * 5 + v.y * 3 + v.z * 7) % 11) / 11;
    };
    struct Setting {
        const char* name;
        std::array<float, 3> values;
        Rgb extinction;
    };
    for (const Setting& s : {Setting{"dead", {1e12f, 1, 0.5f}, Rgb(0.3f)},
                             Setting{"values", {1e12f, 1, 0.5f}, {3e-13f, 0.3f, 0.6f}},
                             Setting{"mixed", {1e12f, 1, 1e6f}, {3e-13f, 0, 0.3f}}}) {
        SCOPED_TRACE(s.name);
        PlainGrid grid(3);
        grid.setLeaf({0, 0, 0}, [&](Vec3i v, int c) {
            return pattern(v) * s.values[static_cast<std::size_t>(c)];
        });
        const PlainMedium plain(
            {{.grid = grid, .absorption = s.extinction, .scattering = Rgb(0.0f)}});
        const Medium medium = plain.medium(1, 3);
        const Vec3d origin{-3, 3.3, 4.1}, direction = normalize(Vec3d{1, 0.1, -0.2});
        constexpr int n = 8000;
        std::vector<TransmittanceQuery<3>> across;
        std::vector<DistanceQuery<3>> weighted;
        for (int i = 0; i < n; ++i) {
            RandomStream random(hashOf(22, i));
            across.push_back({.origin = origin,
                              .direction = direction,
                              .tMax = 1e3,
                              .random = random,
                              .contribution = Spectrum<3>(1)});
            const double u = random.uniformOpenLow();
            weighted.push_back({.origin = origin,
                                .direction = direction,
                                .tMax = 1e3,
                                .u = u,
                                .random = random,
                                .throughput = Spectrum<3>(1)});
        }
        TrackingCounters counters;
        trackTransmittance<3>(medium, across, counters);
        trackDistance<3>(medium, weighted, counters);
        EXPECT_LT(static_cast<double>(counters.collisions) / n, 200);
        EXPECT_LT(static_cast<double>(counters.segments) / n, 200);
        const Vec3d exact = plain.transmittance(origin, direction, 1e3);
        for (int c = 0; c < 3; ++c) {
            Moments ratio, weight;
            for (const auto& q : across) ratio.add(q.contribution[c]);
            for (const auto& q : weighted) weight.add(q.throughput[c]);
            expectMean(ratio, exact[c], 0.02, fmt::format("transmittance {}", c));
            expectMean(weight, exact[c], 0.02, fmt::format("weight {}", c));
        }
    }
}

/// A ray beside a spike in a haze: where the cell is cut, its lower bound, the haze, still
/// counts for the way before the cut.
TEST(RefinedWalk, HazeBesideASpikeCountsBeforeTheCut) {
    constexpr float haze = 0.02f, extinction = 5;
    PlainGrid grid;
    for (int i = 0; i < 8; ++i)
        grid.setLeaf({8 * (i & 1), 8 * (i >> 1 & 1), 8 * (i >> 2)}, [&](Vec3i v, int) {
            return i == 0 && v == Vec3i{5, 3, 3} ? 1.0f : haze;
        });
    const Medium medium =
        PlainMedium({{.grid = grid, .absorption = Rgb(extinction), .scattering = Rgb(0.0f)}})
            .medium(1, 3);
    Moments m;
    for (int i = 0; i < 20000; ++i) {
        TransmittanceQuery<1> q{.origin = {0, 1.5, 1.5},
                                .direction = {1, 0, 0},
                                .tMax = 8,
                                .random = RandomStream(hashOf(11, i)),
                                .contribution = Spectrum<1>(1)};
        TrackingCounters counters;
        trackTransmittance<1>(medium, {&q, 1}, counters);
        m.add(q.contribution[0]);
    }
    expectMean(m, std::exp(-8.0 * haze * extinction), 0.005, "haze");
}

}  // namespace
}  // namespace woodcock::test
