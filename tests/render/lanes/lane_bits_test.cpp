// SPDX-License-Identifier: Apache-2.0
// The same bits, however many lanes there are, and whatever else is in a batch.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "tests/render/lanes/lane_subjects.h"
#include "woodcock/render/lanes/lane_scene.h"

namespace woodcock::test {

using namespace render;

namespace {

void expectSameBits(const std::vector<PathResult>& a, const std::vector<PathResult>& b) {
    ASSERT_EQ(a.size(), b.size());
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    for (std::size_t i = 0; i < a.size(); ++i) {
        const image::FilmSample &x = a[i].film, &y = b[i].film;
        for (int c = 0; c < 3; ++c)
            ASSERT_EQ(bits(x.radiance[c]), bits(y.radiance[c]))
                << "path " << i << ": " << x.radiance[c] << ' ' << y.radiance[c];
        ASSERT_EQ(bits(x.alpha), bits(y.alpha)) << "path " << i;
        ASSERT_EQ(x.events, y.events) << "path " << i;
    }
}

/// Has the library choose one set of instructions, while it lives.
struct Target {
    explicit Target(std::int64_t target) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().DeInit();
    }
    ~Target() {
        hwy::SetSupportedTargetsForTest(0);
        hwy::GetChosenTarget().DeInit();
    }
};

class LaneBits : public testing::Test {
protected:
    /// Calls check(scene, options) for scenes of all kinds.
    template <class Check>
    void forEachKind(Check&& check) {
        for (const LaneSubjects::Named& kind : LaneSubjects::kinds()) {
            SCOPED_TRACE(kind.name);
            const Scene scene = subjects.scene(kind.text);
            const LightDepths depths(scene, {}, ApproximateMedia(scene, {}));
            PathTracer::Options options;
            options.width = options.height = 8, options.seed = 7, options.lightDepths = &depths;
            const auto cameraDepths = CameraDepths::make(scene, options.width, options.height);
            options.cameraDepths = cameraDepths.get();
            const auto radiance = RadianceLattice::make(scene);
            options.radiance = radiance.get();
            EXPECT_TRUE(LaneScene::make(TracedScene(scene, findNeeds(scene), options)));
            check(scene, options);
        }
    }

    LaneSubjects subjects;
};

/// One, four, eight and sixteen lanes.
TEST_F(LaneBits, AreThoseOfOneLaneForAllLengthsOfVectors) {
    if (HWY_STATIC_TARGET != HWY_SCALAR)
        GTEST_SKIP() << "a build for newer processors alone (-march) has nothing of one lane";
    const std::vector<PathJob> jobs = jobsOf(8, 3);
    const std::int64_t supported = hwy::SupportedTargets();
    forEachKind([&](const Scene& scene, const PathTracer::Options& options) {
        std::vector<PathResult> alone;
        {
            const Target chosen(HWY_SCALAR);
            alone = trace(scene, options, jobs);
        }
        for (const std::int64_t target : {HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
            if (!(supported & target)) continue;
            SCOPED_TRACE(hwy::TargetName(target));
            const Target chosen(target);
            expectSameBits(trace(scene, options, jobs), alone);
        }
    });
}

TEST_F(LaneBits, AreThePathsOwn) {
    const std::vector<PathJob> jobs = jobsOf(8, 2);
    forEachKind([&](const Scene& scene, const PathTracer::Options& options) {
        const auto together = trace(scene, options, jobs);
        // Backwards, and in batches of other lengths.
        const std::vector<PathJob> reversed(jobs.rbegin(), jobs.rend());
        std::vector<PathResult> parts;
        for (std::size_t from = 0; from < reversed.size();) {
            const std::size_t count = std::min(reversed.size() - from, from % 13 + 1);
            for (PathResult& r : trace(scene, options, std::span(reversed).subspan(from, count)))
                parts.push_back(std::move(r));
            from += count;
        }
        std::ranges::reverse(parts);
        expectSameBits(parts, together);
    });
}

}  // namespace

}  // namespace woodcock::test
