// SPDX-License-Identifier: Apache-2.0
// Renders that are interrupted and go on, bit for bit as if nothing had been.
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "tests/support/same_films.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/image/write_exr.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/render/saved_state.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

const StateFacts facts{{"scene", "0123"}, {"files", "4567"}};

/// Fog before a sky, over a ground that catches shadows: films keep all that they can.
Scene fogOverGround() {
    return sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = [1, 2, 0.5]\n"
        "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\n"
        "[[surface]]\nmaterial = \"grey\"\nshadow_catcher = true\n"
        "plane = { size = [20, 20] }\ntransform = { translate = [0, -1, 0] }\n"
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, 0]\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.3\n"
        "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 40\n");
}

RenderSettings settings(int samples) {
    RenderSettings s;
    s.width = 70, s.height = 50, s.endSample = samples;
    s.seed = 9;
    s.layers.features = true;
    return s;
}

/// Of a part of the picture, mattes and deep pixels, too.
RenderSettings compositing(int samples) {
    RenderSettings s = settings(samples);
    s.crop = Film::Window{25, 10, 52, 43};
    s.mattes = {{"CryptoObject", {"fog", "ground"}, {0, 1}}, {"CryptoMaterial", {"all"}, {0, 0}}};
    s.deepError = 0.02;
    return s;
}

void expectSameBits(const RenderState& a, const RenderState& b) {
    test::expectSameBits(a.film, b.film);
    ASSERT_EQ(a.mattes.has_value(), b.mattes.has_value());
    if (a.mattes) test::expectSameBits(*a.mattes, *b.mattes);
    ASSERT_EQ(a.deep.has_value(), b.deep.has_value());
    if (a.deep) test::expectSameBits(*a.deep, *b.deep);
    EXPECT_EQ(a.drawn, b.drawn);
}

class Resume : public testing::Test {
protected:
    /// Writes and reads the state, as another process would.
    RenderState throughAFile(const RenderState& state, const RenderSettings& s) const {
        const Film::Window picture{0, 0, s.width, s.height};
        const SavedState saved(state, s, picture, Ending::Unfinished, facts);
        writeExr(dir / "a.exr", state.film, {}, {}, &saved.filmState());
        const StateFile file(dir / "a.exr", "checkpoint");
        checkGoesOn(file, s, picture, facts);
        return readState(file);
    }

    /// Renders with interruptions, as often as the render is asked whether it goes on; less often
    /// where a slow machine finishes no tile meanwhile.
    RenderResult inPieces(const RenderSettings& s, int* interruptions) const {
        std::optional<RenderState> from;
        for (int patience = 0;;) {
            const std::vector<std::uint32_t> before =
                from ? from->drawn : std::vector<std::uint32_t>();
            int asked = 0;
            RenderResult result =
                render::render(scene, s, [&](const RenderProgress&) { return ++asked <= patience; },
                               {.from = std::move(from)});
            if (result.reason != StopReason::Interrupted) return result;
            patience += result.drawn == before;
            from = throughAFile(result, s);
            ++*interruptions;
        }
    }

    /// On a machine so fast that it is done before it can be interrupted, it draws more.
    void expectSameInPieces(RenderSettings s) const {
        int interruptions = 0;
        std::optional<RenderResult> pieces(inPieces(s, &interruptions));
        while (interruptions == 0) {
            s.endSample *= 4, s.noise /= 2;
            pieces.emplace(inPieces(s, &interruptions));
        }
        const RenderResult whole = render::render(scene, s);
        expectSameBits(whole, *pieces);
        EXPECT_EQ(whole.reason, pieces->reason);
        EXPECT_EQ(whole.endSample, pieces->endSample);
        EXPECT_EQ(whole.counters.paths, pieces->counters.paths);
        EXPECT_EQ(whole.counters.distanceCollisions, pieces->counters.distanceCollisions);
    }

    const Scene scene = fogOverGround();
    const TempDir dir;
};

TEST_F(Resume, GivesTheBitsOfOneRender) { expectSameInPieces(settings(100)); }

TEST_F(Resume, GoesOnWithinARangeOfSamplesAndATile) {
    RenderSettings s = settings(150);
    s.firstSample = 50;
    s.crop = Film::Window{5, 7, 60, 49};
    expectSameInPieces(s);
}

TEST_F(Resume, KeepsTheAdaptivePlan) {
    RenderSettings s = settings(100);
    s.adaptive = true;
    expectSameInPieces(s);
}

TEST_F(Resume, KeepsMattesAndDeepPixels) {
    RenderSettings s = compositing(100);
    expectSameInPieces(s);
    s.adaptive = true;
    expectSameInPieces(s);
}

/// Passes end where they would have ended, so the noise is looked at where it would have been.
TEST_F(Resume, StopsAtTheSameNoise) {
    RenderSettings s = settings(4000);
    s.noise = 0.15;
    const RenderResult whole = render::render(scene, s);
    ASSERT_EQ(whole.reason, StopReason::NoiseReached);
    expectSameInPieces(s);
}

/// Copies of a render at work are as good as what an interruption leaves, also those of its last
/// moment.
TEST_F(Resume, GoesOnFromCopiesOfARenderAtWork) {
    for (const bool adaptive : {false, true}) {
        RenderSettings s = compositing(50);
        s.adaptive = adaptive;
        std::vector<RenderState> states;
        const auto draw = [&] {
            states.clear();
            return render::render(
                scene, s, {},
                {.wanted = [] { return true; },
                 .write = [&](const RenderState& state) { states.push_back(state); }});
        };
        std::optional<RenderResult> whole(draw());
        while (states.size() < 2) {  // a fast machine has to draw more
            s.endSample *= 4;
            whole.emplace(draw());
        }
        for (const std::size_t i : {std::size_t{0}, states.size() / 2, states.size() - 1})
            expectSameBits(*whole,
                           render::render(scene, s, {}, {.from = throughAFile(states[i], s)}));
    }
}

TEST_F(Resume, MayAskForMoreSamples) {
    const RenderResult begun = render::render(scene, settings(10));
    const RenderResult more =
        render::render(scene, settings(24), {}, {.from = throughAFile(begun, settings(24))});
    expectSameBits(render::render(scene, settings(24)), more);
    expectError(ErrorKind::Usage, "the checkpoint holds samples up to 10 of a pixel, and only 0:9",
                [&] { render::render(scene, settings(9), {}, {.from = begun}); });
}

TEST_F(Resume, CountsTheTimeBefore) {
    RenderSettings s = settings(1 << 20);
    s.timeLimit = 0.2;
    RenderResult begun = render::render(scene, s);
    ASSERT_EQ(begun.reason, StopReason::TimeLimit);
    EXPECT_GE(begun.seconds, 0.1);
    const double before = begun.seconds = 1000;
    const RenderResult rest = render::render(scene, s, {}, {.from = begun});
    EXPECT_EQ(rest.reason, StopReason::TimeLimit);
    EXPECT_GE(rest.seconds, before);
    EXPECT_EQ(rest.drawn, begun.drawn);
}

TEST_F(Resume, RefusesWhatIsNotItsOwn) {
    const RenderSettings s = settings(4);
    const RenderResult result = render::render(scene, s);
    throughAFile(result, s);
    const StateFile file(dir / "a.exr", "checkpoint");
    const auto refuse = [&](const std::string& message, auto change, StateFacts other = facts) {
        RenderSettings changed = s;
        change(changed);
        expectError(ErrorKind::Input, message, [&] {
            checkGoesOn(file, changed, {0, 0, changed.width, changed.height}, other);
        });
    };
    const auto same = [](RenderSettings&) {};
    refuse("it is of another scene: its digest is 0123, and that of this render 89ab", same,
           {{"scene", "89ab"}, {"files", "4567"}});
    refuse(
        "the files of the scene have changed since: its digest is 4567, and that of this render "
        "0",
        same, {{"scene", "0123"}, {"files", "0"}});
    refuse("it has the pixels 0,0,70,50 of 70 x 50, and asked for are 0,0,80,50 of 80 x 50",
           [](RenderSettings& o) { o.width = 80; });
    refuse("asked for are 1,0,70,50", [](RenderSettings& o) {
        o.crop = Film::Window{1, 0, 70, 50};
    });
    refuse("the seed is '9' there and '8' here", [](RenderSettings& o) { o.seed = 8; });
    refuse("the first sample is '0' there and '2' here",
           [](RenderSettings& o) { o.firstSample = 2; });
    refuse("adaptive sampling is 'no' there and 'yes' here",
           [](RenderSettings& o) { o.adaptive = true; });
    refuse("sampled for layers is 'depth and features' there and 'light' here",
           [](RenderSettings& o) { o.layers.features = false; });
    refuse("Go on with what it was made by, or remove the file to begin anew",
           [](RenderSettings& o) { o.seed = 8; });
}

TEST_F(Resume, RefusesOtherMattesAndDeepPixels) {
    const RenderSettings s = compositing(2);
    const RenderResult result = render::render(scene, s);
    throughAFile(result, s);
    const StateFile file(dir / "a.exr", "checkpoint");
    const auto refuse = [&](const std::string& message, auto change) {
        RenderSettings changed = s;
        change(changed);
        expectError(ErrorKind::Input, message, [&] {
            checkGoesOn(file, changed, {0, 0, s.width, s.height}, facts);
        });
        expectError(ErrorKind::Usage, "of another size or with other layers",
                    [&] { render::render(scene, changed, {}, {.from = readState(file)}); });
    };
    refuse("CryptoMaterial, deep pixels of error 0.02' there and 'depth and features' here",
           [](RenderSettings& o) { o.mattes.clear(), o.deepError = 0; });
    refuse("deep pixels of error 0.5' here", [](RenderSettings& o) { o.deepError = 0.5; });
    refuse("the names of mattes are ", [](RenderSettings& o) { o.mattes[0].names[1] = "grass"; });
}

TEST_F(Resume, RefusesAnotherNumberOfSamplesOfAnAdaptivePlan) {
    RenderSettings s = settings(40);
    s.adaptive = true;
    throughAFile(render::render(scene, s), s);
    const StateFile file(dir / "a.exr", "checkpoint");
    s.endSample = 41;
    expectError(ErrorKind::Input, "from which the plan of an adaptive render follows", [&] {
        checkGoesOn(file, s, {0, 0, s.width, s.height}, facts);
    });
}

}  // namespace
}  // namespace woodcock::test
