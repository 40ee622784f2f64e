// SPDX-License-Identifier: Apache-2.0
// Where camera rays lose their light, and where what they meet first lies.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

std::string box(const std::string& coefficients) {
    return "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n" + coefficients;
}
const std::string light = "[[light]]\ntype = \"environment\"\n";
const std::string camera = pencilCamera({5, 0, 0}, {-1, 0, 0});
const std::string wall = "[[surface]]\nbox = { min = [-3, -9, -9], max = [-2, 9, 9] }\n";

Film film(const std::string& text, int samples = 4) {
    RenderSettings s;
    s.width = s.height = 4, s.endSample = samples, s.maxScatterings = 0;
    s.layers.stops = s.layers.places = true;
    return render::render(sceneFrom(text + light + camera), s).film;
}

TEST(ExactDepths, LieWhereTheTransmittanceFallsSoFar) {
    const Film f = film(box("sigma_a = 1\nsigma_s = 2\n"));
    EXPECT_NEAR(f.firstDepth(1, 1), 4 - std::log(0.99) / 3, 1e-5);
    EXPECT_NEAR(f.halfDepth(1, 1), 4 + std::log(2.0) / 3, 1e-5);
}

TEST(ExactDepths, AreOfTheMeanOverChannels) {
    const Film f = film(box("sigma_a = [0, 1, 3]\nsigma_s = 0\n"));
    const double t = f.halfDepth(1, 1) - 4;
    EXPECT_NEAR((1 + std::exp(-t) + std::exp(-3 * t)) / 3, 0.5, 1e-5);
}

TEST(ExactDepths, ThinMediaTakeNoHalf) {
    const Film f = film(box("sigma_a = 0.1\nsigma_s = 0\n"));
    EXPECT_NEAR(f.firstDepth(1, 1), 4 - std::log(0.99) / 0.1, 1e-5);
    EXPECT_EQ(f.halfDepth(1, 1), Film::noDepth);
    EXPECT_EQ(film(box("sigma_a = 0.001\nsigma_s = 0\n")).firstDepth(1, 1), Film::noDepth);
}

TEST(ExactDepths, OverlappingMediaAddUp) {
    const Film f =
        film(box("sigma_a = 0.5\nsigma_s = 0\n") + box("sigma_a = 0.25\nsigma_s = 0.25\n"));
    EXPECT_NEAR(f.halfDepth(1, 1), 4 + std::log(2.0), 1e-5);
}

TEST(ExactDepths, SurfacesStopWhatIsLeft) {
    const Film f = film(box("sigma_a = 0.1\nsigma_s = 0\n") + wall);
    EXPECT_NEAR(f.firstDepth(1, 1), 4 - std::log(0.99) / 0.1, 1e-5);
    EXPECT_NEAR(f.halfDepth(1, 1), 7, 1e-5);
    const Film alone = film(wall);
    EXPECT_NEAR(alone.firstDepth(1, 1), 7, 1e-5);
    EXPECT_NEAR(alone.halfDepth(1, 1), 7, 1e-5);
    EXPECT_EQ(film(wall + "holdout = true\n").firstDepth(1, 1), Film::noDepth);
}

TEST(ExactDepths, GoThroughBoundariesThatLightPasses) {
    const Film f = film(
        "[[surface]]\nsphere = { centre = [0, 0, 0], radius = 1 }\nmaterial = \"air\"\n"
        "medium = { sigma_a = 1 }\n[[material]]\nname = \"air\"\ntype = \"interface\"\n");
    EXPECT_NEAR(f.halfDepth(1, 1), 4 + std::log(2.0), 1e-5);
}

TEST(CameraPlaces, AreWhereDepthIs) {
    const Film f = film(wall);
    EXPECT_NEAR(f.position(1, 1).x, -2, 1e-5);
    EXPECT_NEAR(f.position(1, 1).y, 0, 1e-5);
    EXPECT_EQ(f.motion(1, 1), (std::array<float, 2>{0, 0}));
    // The eye is at x = 5, and looks along -x.
    const Film smoke = film(box("sigma_a = 1\nsigma_s = 0\n"), 64);
    EXPECT_NEAR(smoke.position(2, 1).x, 5 - smoke.depth(2, 1), 1e-5);
    EXPECT_EQ(film(wall + "holdout = true\n").position(1, 1).x, 0);
}

}  // namespace
}  // namespace woodcock::test
