// SPDX-License-Identifier: Apache-2.0
// The parts of a picture's light: that they sum to it, and that each is what its name says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;
using enum LightKind;

namespace {

constexpr std::array allKinds{VolumeDirect,  VolumeIndirect,  Emission,
                              SurfaceDirect, SurfaceIndirect, Background};

const std::string smoke =
    "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
    "sigma_a = [0.2, 0.3, 0.4]\nsigma_s = [1.5, 1.2, 0.9]\n";
const std::string greySmoke =
    "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0.3\nsigma_s = 1.5\n";
const std::string fire =
    "[[volume]]\nbox = { min = [-0.5, -1, -0.5], max = [0.5, 0.5, 0.5] }\n"
    "sigma_a = 0.1\nsigma_s = 0.2\nemission = [2, 1, 0.25]\ngroup = \"fire\"\n";
const std::string embers =
    "[[volume]]\nbox = { min = [-0.7, -1, -0.7], max = [0.7, -0.5, 0.7] }\nsigma_a = 0\n"
    "emission = [1, 0.5, 0]\ngroup = \"embers\"\n";
const std::string key =
    "[[light]]\ntype = \"sphere\"\nposition = [-2, 3, 2]\nradius = 0.5\nradiance = 20\n"
    "group = \"key\"\n";
const std::string sky = "[[light]]\ntype = \"environment\"\nradiance = [0.2, 0.3, 0.5]\n";
const std::string sun =
    "[[light]]\ntype = \"sun\"\nelevation = 40\nangular_diameter = 20\nvisible = true\n"
    "group = \"sun\"\n";
const std::string lamp =
    "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [3, 2, 1]\n"
    "group = \"lamp\"\n"
    "[[surface]]\nmaterial = \"lamp\"\nbox = { min = [1.2, -1, -0.5], max = [1.5, 0, 0.5] }\n";
const std::string ground =
    "[[surface]]\nplane = {}\ntransform = { translate = [0, -1, 0] }\nmaterial = \"paint\"\n"
    "[[material]]\nname = \"paint\"\ntype = \"diffuse\"\ncolour = [0.7, 0.5, 0.3]\n";
const std::string glass =
    "[[surface]]\nsphere = { centre = [-1.5, -0.4, 1], radius = 0.5 }\nmaterial = \"glass\"\n"
    "medium = { sigma_a = 0.1, emission = [0, 0.5, 0], group = \"glow\" }\n"
    "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\n";
const std::string camera = "[camera]\neye = [0, 1, 6]\nlook_at = [0, -0.2, 0]\nfov = 40\n";

/// All parts of a scene's picture, and the picture.
Film split(const std::string& text, int samples = 8,
           const std::function<void(RenderSettings&)>& edit = {}) {
    const scene::SceneDescription description =
        scene::parseSceneText(text, "scene.toml", ".", {"output.layers=all"});
    RenderSettings settings = scene::renderSettings(description.render);
    settings.width = 24, settings.height = 16, settings.endSample = samples;
    settings.layers = scene::layerNeeds(description);
    if (edit) edit(settings);
    const Scene scene = scene::buildScene(description, scene::loadScene(description));
    return render::render(scene, settings).film;
}

/// To the rounding of a path's and of a pixel's floats.
void expectSumsToThePicture(const Film& film, std::size_t groups) {
    float brightest = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const Rgb picture = film.radiance(x, y);
            std::array<double, 3> kinds{}, ofGroups{};
            for (int c = 0; c < 3; ++c) {
                const auto i = static_cast<std::size_t>(c);
                for (const LightKind kind : allKinds) kinds[i] += film.light(kind, x, y)[c];
                for (std::size_t g = 0; g < groups; ++g)
                    ofGroups[i] += film.lightOfGroup(static_cast<LightGroup>(g), x, y)[c];
                const double rounding = 1e-6 * picture[c];
                ASSERT_NEAR(kinds[i], picture[c], rounding) << x << ' ' << y << ' ' << c;
                ASSERT_NEAR(groups > 0 ? ofGroups[i] : picture[c], picture[c], rounding)
                    << x << ' ' << y << ' ' << c;
                brightest = std::max(brightest, picture[c]);
            }
        }
    EXPECT_GT(brightest, 0);
}

TEST(LightParts, SumToThePictureWhateverTheScene) {
    const auto check = [](const std::string& text, std::size_t groups,
                          const std::function<void(RenderSettings&)>& edit = {}) {
        SCOPED_TRACE(text);
        expectSumsToThePicture(split(text + camera, 8, edit), groups);
    };
    check(smoke + sky, 0);
    check(smoke + fire + embers + key + sky, 4);
    check(greySmoke + fire + key + sky, 3);
    check(smoke + fire + key + sun + sky + lamp + ground + glass, 6);
    check(greySmoke + fire + key + sun + sky + lamp + ground + glass, 6);
    // Clamped samples keep their parts in proportion.
    check(smoke + fire + key + ground, 3, [](RenderSettings& s) { s.approximations.clamp = 0.5; });
    // Equiangular points lie on the second leg of their rays; transparent shadows go through glass.
    check(greySmoke + glass + ground +
              "[[light]]\ntype = \"point\"\nposition = [0, 0.5, 0.5]\ngroup = \"p\"\n",
          3, [](RenderSettings& s) { s.approximations.transparentShadows = true; });
}

/// What a shadow catcher sends out is not in the picture; what is in front of it is.
TEST(LightParts, OfAShadowCatcherAreThoseOfThePicture) {
    const std::string catcher =
        "[[surface]]\nplane = {}\ntransform = { translate = [0, -1, 0] }\nshadow_catcher = true\n";
    const Film film = split(fire + key + sky + catcher + camera, 16);
    expectSumsToThePicture(film, 3);
    for (int x = 0; x < film.width(); ++x)
        EXPECT_EQ(film.light(SurfaceDirect, x, 15).maximum(), 0) << x;
}

TEST(LightParts, AskingForThemChangesNothingElse) {
    const std::string text = smoke + fire + key + sun + sky + lamp + ground + glass + camera;
    const Film with = split(text),
               without = split(text, 8, [](RenderSettings&s) { s.layers = {}; });
    for (int y = 0; y < with.height(); ++y)
        for (int x = 0; x < with.width(); ++x)
            EXPECT_EQ(with.radiance(x, y), without.radiance(x, y));
}

TEST(LightParts, OneEventIsDirectAndMoreAreNot) {
    const Film once =
        split(greySmoke + key + sky + camera, 8, [](RenderSettings& s) { s.maxScatterings = 1; });
    const Film often = split(greySmoke + key + sky + camera);
    double indirect = 0, direct = 0;
    for (int y = 0; y < once.height(); ++y)
        for (int x = 0; x < once.width(); ++x) {
            EXPECT_EQ(once.light(VolumeIndirect, x, y).maximum(), 0);
            direct += once.light(VolumeDirect, x, y)[0];
            indirect += often.light(VolumeIndirect, x, y)[0];
        }
    EXPECT_GT(direct, 0);
    EXPECT_GT(indirect, 0);
}

TEST(LightParts, KindsFollowTheFirstEventThatTheCameraSees) {
    // Fire lights the ground, the ground lights nothing that is seen: no medium scatters.
    const std::string flame =
        "[[volume]]\nbox = { min = [-0.5, -0.9, -0.5], max = [0.5, 0.5, 0.5] }\nsigma_a = 0\n"
        "emission = 1\n";
    const Film film = split(flame + ground + sky + camera, 16);
    double surface = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            EXPECT_EQ(film.light(VolumeDirect, x, y).maximum(), 0);
            EXPECT_EQ(film.light(VolumeIndirect, x, y).maximum(), 0);
            EXPECT_EQ(film.light(SurfaceIndirect, x, y).maximum(), 0);  // a plane sees no plane
            surface += film.light(SurfaceDirect, x, y)[0];
        }
    EXPECT_GT(surface, 0);
    // Towards the horizon and above, there is the sky alone.
    EXPECT_EQ(film.light(Background, 12, 0), film.radiance(12, 0));
}

/// Radiance q times length: 2 units of it lie on the camera's way.
TEST(LightParts, AVolumeThatGlowsAloneIsItsOwnGroup) {
    const std::string glow =
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0\n"
        "emission = [1, 0.5, 0.25]\ngroup = \"glow\"\n";
    const Film film = split(glow + "[[light]]\ntype = \"environment\"\nradiance = 3\n" +
                            pencilCamera({0, 0, 5}, {0, 0, -1}));
    for (int c = 0; c < 3; ++c) {
        const double expected = std::array{2.0, 1.0, 0.5}[static_cast<std::size_t>(c)];
        EXPECT_NEAR(film.lightOfGroup(1, 3, 3)[c], expected, 1e-5);
        EXPECT_NEAR(film.light(Emission, 3, 3)[c], expected, 1e-5);
        EXPECT_NEAR(film.lightOfGroup(0, 3, 3)[c], 3, 1e-5);
        EXPECT_NEAR(film.light(Background, 3, 3)[c], 3, 1e-5);
    }
}

double meanOf(const Film& film, const std::function<Rgb(int, int)>& value) {
    double sum = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) sum += value(x, y).mean();
    return sum / (film.width() * film.height());
}

/// A group of a scene is what the scene with all other lights dark shows.
TEST(LightParts, AGroupIsThePictureWithItsLightsAlone) {
    const std::string darkFire =
        "[[volume]]\nbox = { min = [-0.5, -1, -0.5], max = [0.5, 0.5, 0.5] }\n"
        "sigma_a = 0.1\nsigma_s = 0.2\n";
    const std::string darkLamp =
        "[[material]]\nname = \"black\"\ntype = \"diffuse\"\ncolour = 0\n"
        "[[surface]]\nmaterial = \"black\"\n"
        "box = { min = [1.2, -1, -0.5], max = [1.5, 0, 0.5] }\n";
    // In the order in which the scene names them.
    const std::array<std::string, 4> alone{fire + darkLamp, darkFire + lamp,
                                           darkFire + darkLamp + key, darkFire + darkLamp + sun};
    std::array<Moments, 4> ratio;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const auto draw = [&](const std::string& lights, std::uint64_t offset) {
            return split(greySmoke + ground + lights + camera, 12,
                         [&](RenderSettings& s) { s.seed = seed + offset; });
        };
        const Film together = draw(fire + lamp + key + sun + sky, 0);
        for (std::size_t g = 0; g < alone.size(); ++g) {
            const Film own = draw(alone[g], 100);
            const auto group = static_cast<LightGroup>(g + 1);
            ratio[g].add(
                meanOf(together, [&](int x, int y) { return together.lightOfGroup(group, x, y); }) /
                meanOf(own, [&](int x, int y) { return own.radiance(x, y); }));
        }
    }
    for (const Moments& m : ratio) {
        const Estimate e(m);
        EXPECT_NEAR(e.mean, 1, 4 * e.error);
        EXPECT_LT(e.error, 0.03);
    }
}

}  // namespace
}  // namespace woodcock::test
