// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/scaling.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/trade/lookup_rate.h"
#include "woodcock/trade/scaling_cloud.h"
#include "woodcock/trade/scaling_runs.h"

namespace woodcock::test {

using namespace grid;
using namespace trade;

namespace {

const ScalingCloud& cloudOf(int side) {
    static const TempDir dir;
    static const ScalingCloud clouds[]{bakeScalingCloud(32, dir.path(), 2),
                                       bakeScalingCloud(64, dir.path(), 2)};
    EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
    return clouds[side == 64];
}

TEST(ScalingCloud, OpticalDepthsAreWhatIsAskedFor) {
    for (const int side : {32, 64})
        for (const double depth : {0.1, 10.0, 1e4}) {
            SCOPED_TRACE(testing::Message() << side << "^3 voxels, optical depth " << depth);
            const ScalingCloud& cloud = cloudOf(side);
            EXPECT_NEAR(meanOpticalDepth(scalingScene(cloud, {.opticalDepth = depth})), depth,
                        1e-5 * depth);
            EXPECT_NEAR(
                meanOpticalDepth(scalingScene(cloud, {.opticalDepth = depth, .volumes = 4})), depth,
                1e-5 * depth);
            // Those far away are not in the picture.
            EXPECT_NEAR(meanOpticalDepth(scalingScene(
                            cloud, {.opticalDepth = depth, .volumes = 256, .apart = true})),
                        depth, 1e-5 * depth);
        }
}

TEST(ScalingCloud, IsTheSameCloudAtAnyNumberOfVoxels) {
    const ScalingCloud &coarse = cloudOf(32), &fine = cloudOf(64);
    EXPECT_GT(fine.activeVoxels, 3 * coarse.activeVoxels);
    EXPECT_NEAR(coarse.unitDepth / fine.unitDepth, 1, 0.2);
    for (const ScalingCloud* c : {&coarse, &fine}) {
        EXPECT_GT(c->load.value, 0);
        EXPECT_GT(c->peer.value, 0);
        EXPECT_GT(c->peerBytes, 4 * c->activeVoxels);
        EXPECT_GT(c->fieldBytes, 0u);
    }
}

TEST(LookAtRandom, SeesTheFieldsMean) {
    // Full interpolation at points of a lattice against one tap each at random places.
    const Field& field = *cloudOf(32).field;
    const Box3d box = field.support();
    constexpr int n = 48;
    double mean = 0;
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3d at{i % n + 0.5, i / n % n + 0.5, i / n / n + 0.5};
        const Vec3d size = box.size();
        mean += double{field.trilinear(
                    box.lower + Vec3d{size.x * at.x, size.y * at.y, size.z * at.z} * (1.0 / n))} /
                (n * n * n);
    }
    for (const bool dependent : {false, true}) {
        const double seen = lookAtRandom(field, 1 << 20, dependent, 7) / (1 << 20);
        EXPECT_NEAR(seen / mean, 1, 0.02) << dependent;
    }
}

TEST(TimeRenders, CountsWhatItTimes) {
    std::vector<TimedRender> renders;
    for (const double depth : {1.0, 20.0})
        renders.push_back({scalingScene(cloudOf(32), {.opticalDepth = depth}), "a render", depth});
    std::vector<std::string> notes{"not yet"};
    for (double budget = 0.5; !notes.empty() && budget < 600; budget *= 4) {  // busy machines
        notes.clear();
        timeRenders(renders, budget, notes);
    }
    EXPECT_TRUE(notes.empty()) << notes.front();
    for (const TimedRender& r : renders) {
        EXPECT_GT(r.microseconds.value, 0);
        EXPECT_GT(r.counters.paths, 0u);
        EXPECT_EQ(r.counters.paths % 256, 0u);
    }
    EXPECT_GT(renders[1].perSample(renders[1].counters.scatterings),
              renders[0].perSample(renders[0].counters.scatterings));
}

TEST(TimeRenders, LeavesOutWhatTakesTooLong) {
    std::vector<TimedRender> renders;
    renders.push_back({scalingScene(cloudOf(32), {.opticalDepth = 1000, .albedo = 1}), "slow", 1});
    std::vector<std::string> notes;
    timeRenders(renders, 1e-6, notes);
    EXPECT_EQ(renders[0].microseconds.value, 0);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("too small for slow ("), std::string::npos) << notes[0];
}

TEST(Scaling, BudgetsThatAreTooSmallAreRefused) {
    expectError(ErrorKind::Usage, "give at least 10.0 s", [] { measureScaling({.budget = 3}); });
}

}  // namespace
}  // namespace woodcock::test
