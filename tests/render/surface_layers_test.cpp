// SPDX-License-Identifier: Apache-2.0
// What surfaces do for compositing, under light whose answer is known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

// A sun from straight above, so that a diffuse ground of albedo 0.5 sends out 0.5 x 2 / pi.
const std::string sun = "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0]\nirradiance = 2\n";
constexpr double lit = 0.5 * 2 / pi;
const std::string grey = "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.5\n";
std::string ground(const std::string& flags = "") {
    return "[[surface]]\nname = \"ground\"\nmaterial = \"grey\"\nplane = {}\n" + flags + "\n";
}
/// Between the camera, which looks down obliquely at the origin, and nothing; its shadow covers the
/// origin.
std::string slabAbove(const std::string& flags = "") {
    return "[[surface]]\nname = \"slab\"\nmaterial = \"grey\"\n"
           "box = { min = [-1, 10, -1], max = [1, 11, 1] }\n" +
           flags + "\n";
}
/// In the camera's way.
std::string slabInFront(const std::string& flags = "") {
    return "[[surface]]\nname = \"front\"\nmaterial = \"grey\"\n"
           "box = { min = [2, 3, -1], max = [4, 3.5, 1] }\n" +
           flags + "\n";
}
const std::string camera = pencilCamera({6, 6, 0}, {-1, -1, 0});

Film film(const std::string& text, int samples = 16) {
    return renderScene(sceneFrom(text + camera),
                       {.width = 4, .height = 4, .samples = samples, .featureLayers = true})
        .film;
}

TEST(SurfaceLayers, DepthAndNormalOfTheFirstSurface) {
    const Film f = film(sun + grey + ground());
    EXPECT_NEAR(f.depth(1, 1), 6 * std::sqrt(2.0), 1e-5);
    const Vec3f n = f.normal(1, 1);
    EXPECT_NEAR(n.x, 0, 1e-6);
    EXPECT_NEAR(n.y, 1, 1e-6);
    EXPECT_NEAR(n.z, 0, 1e-6);
    EXPECT_NEAR(f.radiance(1, 1)[1], lit, 1e-5);
    EXPECT_EQ(f.alpha(1, 1), 1);
}

TEST(SurfaceLayers, FogInFrontTakesItsPartOfTheNormal) {
    // Fog of depth ln 2 along the ray: half the rays meet the ground.
    const std::string fog = fmt::format(
        "[[volume]]\nbox = {{ min = [-9, 1, -9], max = [9, 2, 9] }}\nsigma_a = {}\nsigma_s = 0\n",
        std::log(2.0) / std::sqrt(2.0));
    const Film f = film(sun + grey + ground() + fog, 4096);
    EXPECT_NEAR(f.normal(1, 1).y, 0.5, 0.04);
    // Down through the fog at the sun's angle, and back along the ray.
    const double down = std::exp(-std::log(2.0) / std::sqrt(2.0));
    EXPECT_NEAR(f.radiance(1, 1)[1], lit * down * 0.5, 1e-5);
    EXPECT_EQ(f.alpha(1, 1), 1);
}

TEST(SurfaceLayers, ShadowsAreBlack) {
    EXPECT_EQ(film(sun + grey + ground() + slabAbove()).radiance(1, 1).maximum(), 0);
}

TEST(SurfaceLayers, HoldoutCutsAHoleAndStillCastsItsShadow) {
    const std::string light = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
    const Film hole = film(light + grey + ground() + slabInFront("holdout = true"));
    EXPECT_EQ(hole.alpha(1, 1), 0);
    EXPECT_EQ(hole.radiance(1, 1).maximum(), 0);
    const Film shadow = film(sun + grey + ground() + slabAbove("holdout = true"));
    EXPECT_EQ(shadow.radiance(1, 1).maximum(), 0);
    EXPECT_EQ(shadow.alpha(1, 1), 1);
}

TEST(SurfaceLayers, HoldoutBehindAbsorbingFogLeavesTheFogsAlpha) {
    const std::string fog =
        "[[volume]]\nbox = { min = [-9, 4, -9], max = [9, 5, 9] }\nsigma_a = 0.5\nsigma_s = 0\n";
    const Film f = film(sun + grey + ground() + slabInFront("holdout = true") + fog);
    EXPECT_NEAR(f.alpha(1, 1), 1 - std::exp(-0.5 * std::sqrt(2.0)), 1e-5);
}

TEST(SurfaceLayers, MatteIsBlackAndOpaque) {
    const Film f = film("[[light]]\ntype = \"environment\"\nradiance = 1\n" + grey + ground() +
                        slabInFront("matte = true"));
    EXPECT_EQ(f.alpha(1, 1), 1);
    EXPECT_EQ(f.radiance(1, 1).maximum(), 0);
}

TEST(SurfaceLayers, InvisibleToTheCameraAloneStillCastsItsShadow) {
    // Black, as the ground would see itself lit by it.
    const std::string black =
        "[[material]]\nname = \"black\"\ntype = \"diffuse\"\ncolour = 0\n"
        "[[surface]]\nmaterial = \"black\"\nbox = { min = [2, 3, -1], max = [4, 3.5, 1] }\n"
        "camera_visible = false\n";
    const Film through = film(sun + grey + ground() + black);
    EXPECT_NEAR(through.radiance(1, 1)[1], lit, 1e-5);
    EXPECT_NEAR(through.depth(1, 1), 6 * std::sqrt(2.0), 1e-5);
    const Film shadow = film(sun + grey + ground() + slabAbove("camera_visible = false"));
    EXPECT_EQ(shadow.radiance(1, 1).maximum(), 0);
}

TEST(SurfaceLayers, ShadowCatcherKeepsTheShadowAlone) {
    const std::string caught = "shadow_catcher = true";
    const Film open = film(sun + grey + ground(caught));
    EXPECT_EQ(open.alpha(1, 1), 0);
    EXPECT_EQ(open.radiance(1, 1).maximum(), 0);
    const Film umbra = film(sun + grey + ground(caught) + slabAbove());
    EXPECT_EQ(umbra.alpha(1, 1), 1);
    EXPECT_EQ(umbra.radiance(1, 1).maximum(), 0);
    // Half of the sunlight in a fog's shadow.
    const std::string fog = fmt::format(
        "[[volume]]\nbox = {{ min = [-1, 20, -1], max = [1, 21, 1] }}\nsigma_a = {}\nsigma_s = 0\n",
        std::log(2.0));
    EXPECT_NEAR(film(sun + grey + ground(caught) + fog).alpha(1, 1), 0.5, 1e-5);
}

/// What glows before the catcher is no light on it.
TEST(SurfaceLayers, ShadowCatcherLeavesWhatStandsInFront) {
    const std::string light =
        "[[light]]\ntype = \"sphere\"\nposition = [3, 3, 0]\nradius = 0.1\nradiance = 5\n";
    const Film f = film(sun + grey + ground("shadow_catcher = true") + light);
    EXPECT_NEAR(f.radiance(1, 1)[1], 5, 1e-5);
    EXPECT_NEAR(f.alpha(1, 1), 0, 1e-5);
}

/// Half of the sky is hidden by a wall that touches the ground: the catcher's alpha is the part of
/// the light that is gone, (1 - cos 90) / 2 of a horizontal surface, plus what a black wall adds:
/// 0.
TEST(SurfaceLayers, ShadowCatcherUnderASkyCountsWhatIsHidden) {
    const std::string light = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
    const std::string wall =
        "[[material]]\nname = \"black\"\ntype = \"diffuse\"\ncolour = 0\n"
        "[[surface]]\nmaterial = \"black\"\nbox = { min = [-300, -1, -300], max = [-0.01, 300, "
        "300] }\n";
    const Film f = film(light + grey + ground("shadow_catcher = true") + wall, 1024);
    Moments alpha;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) alpha.add(f.alpha(x, y));
    expectAgrees(Estimate(alpha), 0.5, 0.01);
}

}  // namespace
}  // namespace woodcock::test
