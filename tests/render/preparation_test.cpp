// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/preparation.h"

#include <gtest/gtest.h>

#include "tests/render/lanes/lane_subjects.h"

namespace woodcock::test {

using namespace render;

namespace {

RenderSettings small(std::optional<int> similarityAfter) {
    RenderSettings s;
    s.width = 12, s.height = 9, s.endSample = 4;
    s.approximations.similarityAfter = similarityAfter;
    return s;
}

std::shared_ptr<const Preparation> prepared(const Scene& scene, const RenderSettings& s) {
    return std::make_shared<const Preparation>(scene, s.width, s.height, s.approximations);
}

void expectSamePicture(const image::Film& a, const image::Film& b) {
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            ASSERT_EQ(a.radiance(x, y), b.radiance(x, y)) << x << ", " << y;
            ASSERT_EQ(a.alpha(x, y), b.alpha(x, y)) << x << ", " << y;
        }
}

TEST(Preparation, LeavesThePictureAsItIs) {
    const LaneSubjects subjects;
    for (const LaneSubjects::Named& kind : LaneSubjects::kinds()) {
        SCOPED_TRACE(kind.name);
        const Scene scene = subjects.scene(kind.text);
        for (const std::optional<int> after : {std::optional<int>(), std::optional<int>(1)}) {
            RenderSettings settings = small(after);
            const auto shared = prepared(scene, settings);
            for (const bool filled : {false, true}) {
                if (filled) shared->fill(1, [] { return true; });
                ++settings.seed;
                expectSamePicture(renderPrepared(scene, settings, shared).film,
                                  render::render(scene, settings).film);
            }
        }
    }
}

TEST(Preparation, OfAnotherRenderHasNoEffect) {
    const LaneSubjects subjects;
    const Scene scene = subjects.scene(LaneSubjects::kinds().front().text);
    const Scene other = subjects.scene(LaneSubjects::kinds().back().text);
    const RenderSettings settings = small(1);
    const image::Film film = render::render(scene, settings).film;
    RenderSettings larger = settings;
    ++larger.width;
    for (const auto& foreign :
         {prepared(other, settings), prepared(scene, small({})), prepared(scene, larger)}) {
        EXPECT_FALSE(
            foreign->fits(scene, settings.width, settings.height, settings.approximations));
        expectSamePicture(renderPrepared(scene, settings, foreign).film, film);
    }
    const RenderSettings later = small(4);
    EXPECT_TRUE(
        prepared(scene, settings)->fits(scene, later.width, later.height, later.approximations))
        << "after any scattering, the same media";
}

}  // namespace
}  // namespace woodcock::test
