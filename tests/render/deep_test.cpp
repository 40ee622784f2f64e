// SPDX-License-Identifier: Apache-2.0
// Deep pixels against the film of the same paths, against exact integration, and against scenes in
// which a surface stands where pixels are cut.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/support/render_scene.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

RenderSettings settingsFor(int samples, double error = 0.01) {
    RenderSettings settings;
    settings.width = settings.height = 8;
    settings.endSample = samples;
    settings.deepError = error;
    return settings;
}
RenderResult deepOf(const std::string& text, int samples = 16,
                    const std::filesystem::path& directory = ".") {
    return render::render(sceneFrom(text, directory), settingsFor(samples));
}

struct Flat {
    double colour = 0, alpha = 0;
};
/// Of what lies in front of a depth, as the format splits samples there.
Flat before(const std::vector<DeepSample>& samples, double depth) {
    Flat flat;
    for (const DeepSample& s : samples) {
        if (s.near >= depth) break;
        double colour = s.colour[0], alpha = s.alpha;
        if (s.far > depth) {
            const double x = (depth - s.near) / (s.far - s.near);
            const double part = -std::expm1(x * std::log1p(-alpha));
            colour *= alpha > 0 ? part / alpha : x;
            alpha = part;
        }
        flat.colour += (1 - flat.alpha) * colour;
        flat.alpha += (1 - flat.alpha) * alpha;
    }
    return flat;
}
constexpr double everything = 1e30;

const std::string dark = "[[light]]\ntype = \"environment\"\nradiance = 0\n";
const std::string hidden = "[[light]]\ntype = \"environment\"\nradiance = 1\nvisible = false\n";
const std::string sky = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
const std::string lamp =
    "[[light]]\ntype = \"sphere\"\nposition = [1, 1, 3]\nradius = 0.5\nradiance = 3\n";
const std::string pencil = pencilCamera({0, 0, 10}, {0, 0, -1});
const std::string wide = "[camera]\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nfov = 40\n";

std::string box(double z0, double z1, const std::string& coefficients) {
    return fmt::format("[[volume]]\nbox = {{ min = [-2, -2, {}], max = [2, 2, {}] }}\n{}\n", z0, z1,
                       coefficients);
}
std::string wall(double z, const std::string& more = "") {
    return fmt::format("[[surface]]\nbox = {{ min = [-1, -1, {}], max = [1, 1, {}] }}\n{}\n",
                       z - 0.5, z, more);
}

/// Flattened, deep pixels are the film. (No background is seen in it.)
void expectFlattened(const RenderResult& r) {
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const Flat flat = before(r.deep->samples(x, y, r.film), everything);
            const double radiance = r.film.radiance(x, y)[0];
            EXPECT_NEAR(flat.alpha, r.film.alpha(x, y), 1e-6) << x << ", " << y;
            EXPECT_NEAR(flat.colour, radiance, 2e-6 * (1 + radiance)) << x << ", " << y;
        }
}

TEST(Deep, FlattenedItIsThePicture) {
    const std::string air = "[[material]]\nname = \"air\"\ntype = \"interface\"\n";
    const std::string scatters = box(-1, 1, "sigma_a = 0.1\nsigma_s = 1");
    const std::vector<std::pair<const char*, std::string>> scenes{
        {"scatters", scatters + hidden},
        {"in colour", box(-1, 1, "sigma_a = [0, 0.1, 0.3]\nsigma_s = [0.5, 1, 2]") + hidden},
        {"glows", box(-1, 1, "sigma_a = 0.5\nsigma_s = 0.5\nemission = 2") + dark},
        {"glows and lets all through", box(-1, 1, "emission = 2") + dark},
        {"overlap", box(-1, 1, "sigma_a = 0.5\nsigma_s = 0\nemission = 1") +
                        box(0, 2, "sigma_a = 1\nsigma_s = 0") + dark},
        {"a lamp in it", box(-1, 4, "sigma_a = 0.1\nsigma_s = 0.3") + lamp},
        {"walls",
         scatters + wall(-1.5) + wall(1.5, "transform = { translate = [0.7, 0.4, 0] }") + hidden},
        {"behind an interface",
         air + scatters + wall(0, "material = \"air\"\nmedium = { sigma_a = 1, sigma_s = 1 }") +
             wall(-2) + hidden},
        {"a shadow catcher", scatters + wall(-2, "shadow_catcher = true") + hidden},
        {"held out", scatters + wall(-1, "holdout = true") + hidden}};
    for (const auto& [what, text] : scenes) {
        SCOPED_TRACE(what);
        expectFlattened(deepOf(text + wide));
    }
}

TEST(Deep, TheBackgroundHasNoSample) {
    const RenderResult r = deepOf(box(-1, 1, "sigma_a = 1\nsigma_s = 0") + sky + wide);
    EXPECT_EQ(r.film.radiance(0, 0)[0], 1);
    EXPECT_TRUE(r.deep->samples(0, 0, r.film).empty());
    const Flat flat = before(r.deep->samples(4, 4, r.film), everything);
    EXPECT_EQ(flat.colour, 0);
    EXPECT_NEAR(flat.alpha, r.film.alpha(4, 4), 1e-6);
}

// An even medium that absorbs and glows: T and the light in front of any depth are closed forms.
TEST(Deep, EvenMediaFollowTheirClosedForm) {
    constexpr double sigma = 1.5, q = 2;
    const RenderResult r =
        deepOf(box(-1, 1, fmt::format("sigma_a = {}\nsigma_s = 0\nemission = {}", sigma, q)) +
                   dark + pencil,
               1024);
    for (const double depth : {9.0, 9.3, 9.7, 10.0, 10.5, 11.0, 12.0}) {
        SCOPED_TRACE(depth);
        const double length = std::clamp(depth, 9.0, 11.0) - 9;
        double colour = 0;
        for (int i = 0; i < 64; ++i) {
            const Flat flat = before(r.deep->samples(i % 8, i / 8, r.film), depth);
            EXPECT_NEAR(flat.alpha, 1 - std::exp(-sigma * length), 1e-6);
            colour += flat.colour / 64;
        }
        // By 64 x 1024 points, whose weights are at most the integral's double.
        EXPECT_NEAR(colour, q / sigma * (1 - std::exp(-sigma * length)), 0.01 + 4 * 1.3 * 2 / 256);
    }
}

GridSpec lumps() {
    GridSpec grid;
    grid.name = "density";
    grid.box = {{-24, -24, -24}, {24, 24, 24}};
    grid.value = [](Vec3i p) {
        const double v = std::sin(p.x * 0.5) + std::cos(p.y * 0.7) + std::sin(p.z * 0.35 + 1);
        return v > 0.4 ? v : 0;
    };
    grid.worldFromIndex = Affine3d::scale({0.1, 0.1, 0.1});
    return grid;
}

TEST(Deep, TransmittanceIsRightAtAnyDepth) {
    const TempDir dir;
    writeVdb(dir / "lumps.vdb", {lumps()});
    const std::string text = "[[volume]]\nfile = \"lumps.vdb\"\nscale = 0.8\nalbedo = 0\n" + dark +
                             pencilCamera({0.31, 0.02, 10}, {0.05, -0.02, -1});
    const Scene scene = sceneFrom(text, dir.path());
    for (const double error : {0.01, 0.1}) {
        SCOPED_TRACE(error);
        const RenderResult r = render::render(scene, settingsFor(256, error));
        const Vec3d origin{0.31, 0.02, 10}, direction = normalize(Vec3d{0.05, -0.02, -1});
        double worst = 0;
        for (double depth = 7; depth < 13; depth += 0.05) {
            const double exact =
                std::exp(-medium::exactOpticalDepth(scene.medium, origin, direction, 0, depth)[0]);
            Moments left;
            for (int i = 0; i < 64; ++i)
                left.add(1 - before(r.deep->samples(i % 8, i / 8, r.film), depth).alpha);
            const double off = std::abs(left.mean() - exact);
            EXPECT_LT(off, error + 4 * left.standardError()) << depth;
            worst = std::max(worst, off);
        }
        EXPECT_LT(worst, error + 0.003);
    }
    const double fine = render::render(scene, settingsFor(1, 0.01)).deep->meanBins();
    const double coarse = render::render(scene, settingsFor(1, 0.1)).deep->meanBins();
    EXPECT_GT(fine, coarse);
    EXPECT_LT(fine, 60);
}

// Deep holdout: what a surface at some depth leaves is what a scene shows where the surface is held
// out of it.
TEST(Deep, CutAtASurfaceItIsTheSceneThatHoldsThatOut) {
    const std::string medium = box(-1, 1, "sigma_a = 0.8\nsigma_s = 0\nemission = 1");
    const RenderResult whole = deepOf(medium + dark + pencil, 512);
    for (const double z : {-0.8, 0.0, 0.45}) {
        SCOPED_TRACE(z);
        const RenderResult held = deepOf(medium + wall(z, "holdout = true") + dark + pencil, 512);
        Moments cut, shown;
        for (int i = 0; i < 64; ++i) {
            const Flat flat = before(whole.deep->samples(i % 8, i / 8, whole.film), 10 - z);
            EXPECT_NEAR(flat.alpha, held.film.alpha(i % 8, i / 8), 1e-6);
            cut.add(flat.colour), shown.add(held.film.radiance(i % 8, i / 8)[0]);
        }
        EXPECT_NEAR(cut.mean(), shown.mean(),
                    0.01 + 4 * std::hypot(cut.standardError(), shown.standardError()));
        EXPECT_LT(cut.standardError(), 0.01);
    }
}

TEST(Deep, DepthIsAlongTheCamerasAxis) {
    const RenderResult r =
        deepOf("[[surface]]\nbox = { min = [-50, -50, -1], max = [50, 50, 0] }\n" + sky +
               "[camera]\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nfov = 90\n");
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const auto samples = r.deep->samples(x, y, r.film);
            ASSERT_EQ(samples.size(), 1u);
            EXPECT_NEAR(samples[0].near, 10, 1e-5);
            EXPECT_EQ(samples[0].near, samples[0].far);
            EXPECT_EQ(samples[0].alpha, 1);
        }
}

TEST(Deep, DepthIsFromWhereAMovingCameraIs) {
    const RenderResult r =
        deepOf("[[surface]]\nbox = { min = [-50, -50, -1], max = [50, 50, 0] }\n" + sky +
                   "[camera]\neye = { keys = [[0, [0, 0, 10]], [1, [0, 0, 12]]], interpolation = "
                   "\"linear\" }\nlook_at = [0, 0, 0]\nfov = 90\nshutter = [0, 1]\n",
               64);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const auto samples = r.deep->samples(x, y, r.film);
            double alpha = 0;
            for (const DeepSample& s : samples) {
                EXPECT_GE(s.near, 10 - 1e-5);
                EXPECT_LE(s.far, 12 + 1e-5);
                alpha += (1 - alpha) * s.alpha;
            }
            EXPECT_NEAR(alpha, 1, 1e-6);
        }
    expectFlattened(r);
}

// A medium that moves through the picture: its bins are chosen in the middle of the shutter.
TEST(Deep, FlattenedMotionIsThePicture) {
    expectFlattened(deepOf(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0.5\nsigma_s = 0.5\n"
        "transform = { translate = { keys = [[0, [-1, 0, -2]], [1, [1, 0, 2]]], interpolation = "
        "\"linear\" } }\n" +
        hidden + "[camera]\neye = [0, 0, 10]\nlook_at = [0, 0, 0]\nfov = 40\nshutter = [0, 1]\n"));
}

TEST(Deep, EndlessMediaAndCamerasInsideAreFinite) {
    const TempDir dir;
    GridSpec grid = lumps();
    grid.background = {0.5};
    writeVdb(dir / "fog.vdb", {grid});
    const std::string fog = "[[volume]]\nfile = \"fog.vdb\"\nbackground = \"endless\"\n";
    for (const char* more : {"scale = 1\nalbedo = 0\n", "scale = 1\nalbedo = 0.5\n",
                             "scale = [1, 0, 0.1]\nalbedo = 0\n"}) {
        SCOPED_TRACE(more);
        const RenderResult r =
            deepOf(fog + more + hidden + "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\n", 4,
                   dir.path());
        expectFlattened(r);
        for (const DeepSample& s : r.deep->samples(3, 3, r.film))
            EXPECT_TRUE(std::isfinite(s.far) && s.near >= 0);
    }
}

TEST(Deep, AdaptiveSamplesWeighAlike) {
    RenderSettings settings = settingsFor(64);
    settings.adaptive = true;
    const RenderResult r = render::render(
        sceneFrom(box(-1, 1, "sigma_a = 0.2\nsigma_s = 0.5") + wall(-1.5) + hidden + wide),
        settings);
    EXPECT_LT(r.film.fewestSamples(), r.film.mostSamples());
    expectFlattened(r);
}

TEST(Deep, DependsNeitherOnThreadsNorOnTheCrop) {
    const Scene scene =
        sceneFrom(box(-1, 1, "sigma_a = 0.2\nsigma_s = 0.5") + wall(0) + hidden + wide);
    RenderSettings settings = settingsFor(8);
    settings.threads = 1;
    const RenderResult one = render::render(scene, settings);
    settings.threads = 3, settings.crop = Film::Window{2, 3, 5, 7};
    const RenderResult three = render::render(scene, settings);
    for (int y = 3; y < 7; ++y)
        for (int x = 2; x < 5; ++x) {
            const auto a = one.deep->samples(x, y, one.film),
                       b = three.deep->samples(x, y, three.film);
            ASSERT_EQ(a.size(), b.size());
            for (std::size_t i = 0; i < a.size(); ++i) {
                EXPECT_EQ(a[i].near, b[i].near);
                EXPECT_EQ(a[i].alpha, b[i].alpha);
                EXPECT_EQ(a[i].colour, b[i].colour);
            }
        }
}

TEST(Deep, BiasedCameraRaysAreRefused) {
    const Scene scene = sceneFrom(box(-1, 1, "sigma_a = 0.2\nsigma_s = 0.5") + hidden + wide);
    const auto refused = [&](auto change, const char* said) {
        RenderSettings settings = settingsFor(1);
        change(settings.approximations);
        expectError(ErrorKind::Usage, said, [&] { render::render(scene, settings); });
    };
    refused([](Approximations& a) { a.marchStep = 0.5; }, "Set march_step = 0");
    refused([](Approximations& a) { a.similarityAfter = 0; }, "Set similarity_after = 1 or more");
    refused([](Approximations& a) { a.clamp = 2; }, "Set clamp = 0");
    RenderSettings settings = settingsFor(1);
    settings.approximations.similarityAfter = 1;
    EXPECT_NO_THROW(render::render(scene, settings));
}

}  // namespace

}  // namespace woodcock::test
