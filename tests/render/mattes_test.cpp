// SPDX-License-Identifier: Apache-2.0
// What mattes show, against the picture's own alpha and against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/mattes.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

struct Matted {
    RenderResult result;
    double coverage(int x, int y, const std::string& name, std::size_t layer = 0) const {
        const auto all = result.mattes->coverage(layer, x, y, result.film.at(x, y).samples);
        const auto& names = result.mattes->layers()[layer].names;
        const auto found = std::find(names.begin(), names.end(), name);
        return found == names.end() ? -1 : all[static_cast<std::size_t>(found - names.begin())];
    }
    double total(int x, int y) const {
        double sum = 0;
        for (double c : result.mattes->coverage(0, x, y, result.film.at(x, y).samples)) sum += c;
        return sum;
    }
    double mean(const std::string& name, std::size_t layer = 0) const {
        double sum = 0;
        const Film::Window crop = result.film.crop();
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x) sum += coverage(x, y, name, layer);
        return sum / (crop.width() * crop.height());
    }
};

RenderSettings settingsFor(int samples) {
    RenderSettings settings;
    settings.width = settings.height = 8;
    settings.endSample = samples;
    return settings;
}

Matted matted(const std::string& text, int samples = 16, bool adaptive = false,
              const std::filesystem::path& directory = ".") {
    const scene::SceneDescription description =
        scene::parseSceneText(text, "scene.toml", directory);
    RenderSettings settings = settingsFor(samples);
    settings.adaptive = adaptive;
    settings.mattes = scene::matteLayers(description, {"object", "material"});
    const Scene scene = scene::buildScene(description, scene::loadScene(description));
    return {render::render(scene, settings)};
}

const std::string light = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
const std::string camera = pencilCamera({0, 0, 10}, {0, 0, -1});
const std::string wide = "[camera]\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nfov = 40\n";

std::string box(const std::string& name, double z0, double z1, const std::string& coefficients) {
    return fmt::format(
        "[[volume]]\nname = \"{}\"\nbox = {{ min = [-2, -2, {}], max = [2, 2, {}] }}\n{}\n", name,
        z0, z1, coefficients);
}
std::string wall(const std::string& name, double z, const std::string& more = "") {
    return fmt::format(
        "[[surface]]\nname = \"{}\"\nbox = {{ min = [-1, -1, {}], max = [1, 1, {}] }}\n{}\n", name,
        z - 0.5, z, more);
}

void expectTotalsAreAlpha(const Matted& m, double within = 1e-7) {
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            EXPECT_NEAR(m.total(x, y), m.result.film.alpha(x, y), within) << x << ", " << y;
}

TEST(Mattes, AddUpToAlphaWhateverIsSeen) {
    const std::string air = "[[material]]\nname = \"air\"\ntype = \"interface\"\n";
    const std::vector<std::pair<const char*, std::string>> scenes{
        {"scatters", box("a", -1, 1, "sigma_a = 0.1\nsigma_s = 0.5")},
        {"scatters in colour", box("a", -1, 1, "sigma_a = [0, 0.1, 0.3]\nsigma_s = [0.5, 1, 2]")},
        {"absorbs", box("a", -1, 1, "sigma_a = 0.5\nsigma_s = 0")},
        {"absorbs in colour", box("a", -1, 1, "sigma_a = [0, 0.2, 5]\nsigma_s = 0")},
        {"overlap", box("a", -1, 1, "sigma_a = 0.5\nsigma_s = 0") +
                        box("b", 0, 2, "sigma_a = 1\nsigma_s = 0")},
        {"overlap and scatter", box("a", -1, 1, "sigma_a = 0.5\nsigma_s = 0.1") +
                                    box("b", 0, 2, "sigma_a = 1\nsigma_s = 1")},
        {"walls", box("a", 0, 1, "sigma_a = 0.5\nsigma_s = 0") + wall("w", -1)},
        {"behind an interface",
         air + box("a", 1, 2, "sigma_a = 0.2\nsigma_s = 0.2") +
             wall("w", 0, "material = \"air\"\nmedium = { sigma_a = 1, sigma_s = 0 }") +
             wall("v", -2)},
        {"held out",
         box("a", 0, 1, "sigma_a = 0.5\nsigma_s = 0.5") + wall("w", -1, "holdout = true")}};
    for (const auto& [what, text] : scenes) {
        SCOPED_TRACE(what);
        const Matted m = matted(text + light + wide);
        expectTotalsAreAlpha(m);
        EXPECT_GT(m.mean("a"), 0.01);
    }
}

TEST(Mattes, AreTinyWhereMediaAre) {
    const Matted m = matted(box("a", -1, 1, "sigma_a = 5e-10\nsigma_s = 0") + light + camera);
    EXPECT_NEAR(m.coverage(3, 3, "a") / 1e-9, 1, 1e-5);
}

TEST(Mattes, AskingForThemChangesNoBit) {
    const std::string text =
        box("a", -1, 1, "sigma_a = 0.5\nsigma_s = [1, 0.5, 0]") + wall("w", -2) + light + wide;
    const scene::SceneDescription description = scene::parseSceneText(text, "scene.toml", ".");
    const Scene scene = scene::buildScene(description, scene::loadScene(description));
    RenderSettings settings = settingsFor(16);
    const RenderResult without = render::render(scene, settings);
    settings.mattes = scene::matteLayers(description, {"object"});
    settings.deepError = 0.01;
    const RenderResult with = render::render(scene, settings);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            EXPECT_EQ(with.film.radiance(x, y), without.film.radiance(x, y));
            EXPECT_EQ(with.film.alpha(x, y), without.film.alpha(x, y));
        }
    EXPECT_EQ(with.counters.distanceCollisions, without.counters.distanceCollisions);
}

// Two media in one place: what each stops is in proportion to its extinction.
TEST(Mattes, OverlappingMediaShareByExtinction) {
    const double all = 1 - std::exp(-2.0 * 1.0);
    for (const char* scattering : {"0", "1"}) {
        SCOPED_TRACE(scattering);
        const bool scatters = scattering[0] == '1';
        const auto coefficients = [&](double sigma) {
            return fmt::format("sigma_a = {}\nsigma_s = {}", scatters ? 0 : sigma,
                               scatters ? sigma : 0);
        };
        const Matted m = matted(box("thin", -0.5, 0.5, coefficients(0.5)) +
                                    box("thick", -0.5, 0.5, coefficients(1.5)) + light + camera,
                                scatters ? 1024 : 4);
        // Of 64 pixels with 1024 samples: at most 1 / 2 / 256.
        const double within = scatters ? 4 * 0.5 / 256 : 1e-6;
        EXPECT_NEAR(m.mean("thin"), all * 0.25, within);
        EXPECT_NEAR(m.mean("thick"), all * 0.75, within);
    }
}

// One medium that reaches into another, along one ray: exact where nothing scatters.
TEST(Mattes, MediaInFrontTakeTheirPartFirst) {
    const Matted m = matted(box("back", -1, 1, "sigma_a = 0.5\nsigma_s = 0") +
                                box("front", 0, 2, "sigma_a = 1\nsigma_s = 0") + wall("wall", -2) +
                                light + camera,
                            1);
    const double before = std::exp(-1.0), both = std::exp(-1.0 - 1.5), left = std::exp(-3.0);
    EXPECT_NEAR(m.coverage(2, 5, "front"), 1 - before + (before - both) * 2 / 3, 1e-6);
    EXPECT_NEAR(m.coverage(2, 5, "back"), (before - both) / 3 + both - left, 1e-6);
    EXPECT_NEAR(m.coverage(2, 5, "wall"), left, 1e-6);
    EXPECT_NEAR(m.total(2, 5), 1, 1e-7);
}

TEST(Mattes, FieldsShareAlongTheirWay) {
    const TempDir dir;
    GridSpec grid;
    grid.name = "density";
    grid.box = {{-20, -20, -8}, {20, 20, 8}};
    grid.value = [](Vec3i p) { return 0.05 * (p.z + 9); };
    grid.worldFromIndex = Affine3d::scale({0.25, 0.25, 0.25});
    writeVdb(dir / "ramp_0012.vdb", {grid});
    // The same grid twice, once three times as dense: a quarter and three quarters everywhere.
    const std::string twice =
        "[[volume]]\nfile = \"ramp_0012.vdb\"\nscale = 0.5\nalbedo = 0\n"
        "[[volume]]\nfile = \"ramp_0012.vdb\"\nscale = 1.5\nalbedo = 0\n";
    const Matted m = matted(twice + light + camera, 2048, false, dir.path());
    expectTotalsAreAlpha(m);
    EXPECT_GT(m.mean("ramp"), 0.2);
    EXPECT_NEAR(m.mean("ramp_2") / m.mean("ramp"), 3, 0.03);
}

TEST(Mattes, BoundariesAreSeenThroughAndWhatTheyHoldIsTheirs) {
    const std::string air = "[[material]]\nname = \"air\"\ntype = \"interface\"\n";
    const Matted m = matted(
        air + wall("shell", 0.5, "material = \"air\"\nmedium = { sigma_a = 2, sigma_s = 0 }") +
            wall("behind", -2) + light + camera,
        1);
    EXPECT_NEAR(m.coverage(1, 1, "shell"), 1 - std::exp(-1.0), 1e-6);
    EXPECT_NEAR(m.coverage(1, 1, "behind"), std::exp(-1.0), 1e-6);
    EXPECT_NEAR(m.coverage(1, 1, "air", 1), 1 - std::exp(-1.0), 1e-6);
    EXPECT_NEAR(m.coverage(1, 1, "default", 1), std::exp(-1.0), 1e-6);
}

TEST(Mattes, AVolumeInASurfaceIsItself) {
    const std::string air = "[[material]]\nname = \"air\"\ntype = \"interface\"\n";
    const Matted m =
        matted(air + box("fog", -3, 3, "sigma_a = 2\nsigma_s = 0") + "inside = \"shell\"\n" +
                   wall("shell", 0.5, "material = \"air\"") + light + camera,
               1);
    EXPECT_NEAR(m.coverage(1, 1, "fog"), 1 - std::exp(-1.0), 1e-6);
    EXPECT_EQ(m.coverage(1, 1, "shell"), 0);
    EXPECT_NEAR(m.coverage(1, 1, "fog", 1), 1 - std::exp(-1.0), 1e-6);
}

TEST(Mattes, HoldoutsAreNothingAndCatchersAreThemselves) {
    EXPECT_EQ(matted(wall("w", 0, "holdout = true") + light + camera, 1).coverage(1, 1, "w"), 0);
    EXPECT_EQ(matted(wall("w", 0, "matte = true") + light + camera, 1).coverage(1, 1, "w"), 1);
    EXPECT_EQ(matted(wall("w", 0, "shadow_catcher = true") + light + camera, 1).coverage(1, 1, "w"),
              1);
}

TEST(Mattes, EdgesOfSurfacesAreCoveredInPart) {
    // The camera's picture is 0.5 wide, and the wall's edge runs through its middle.
    const Matted m = matted(
        "[[surface]]\nname = \"w\"\nbox = { min = [0, -9, -1], max = [9, 9, 0] }\n" + light +
            "[camera]\ntype = \"orthographic\"\neye = [0.03125, 0, 5]\nlook_at = [0.03125, 0, 0]\n"
            "height = 0.5\n",
        256);
    for (int y = 0; y < 8; ++y) {
        EXPECT_EQ(m.coverage(0, y, "w"), 0);
        EXPECT_NEAR(m.coverage(3, y, "w"), 0.5, 4 * 0.5 / 16);
        EXPECT_EQ(m.coverage(7, y, "w"), 1);
    }
}

TEST(Mattes, AdaptiveSamplesWeighAlike) {
    const Matted m = matted(
        box("a", -1, 1, "sigma_a = 0.2\nsigma_s = 0.5") + wall("w", -1.5) + light + wide, 64, true);
    EXPECT_LT(m.result.film.fewestSamples(), m.result.film.mostSamples());
    expectTotalsAreAlpha(m);
}

TEST(Mattes, PlanesAreAllThatIsKept) {
    Matted m = matted(box("a", -1, 1, "sigma_a = 0.5\nsigma_s = 0") + light + camera, 4);
    auto planes = m.result.mattes->planes();
    ASSERT_EQ(planes.size(), 2u);
    EXPECT_EQ(planes[0].name, "CryptoObject");
    EXPECT_EQ(planes[0].components, 1);
    const double before = m.coverage(5, 5, "a");
    planes[0].sums[5 * 8 + 5] *= 2;
    EXPECT_DOUBLE_EQ(m.coverage(5, 5, "a"), 2 * before);
}

}  // namespace

}  // namespace woodcock::test
