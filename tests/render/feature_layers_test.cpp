// SPDX-License-Identifier: Apache-2.0
// What denoisers are told of a picture: albedo, normal and variance.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/plain_grid.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace camera;
using namespace grid;
using namespace image;
using namespace light;
using namespace medium;
using namespace proof;
using namespace render;

namespace {

const std::string sky = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
const std::string camera = pencilCamera({5, 0.2, 0.1}, {-1, 0, 0});
const std::string redWall =
    "[[material]]\nname = \"red\"\ntype = \"diffuse\"\ncolour = [0.8, 0.3, 0.1]\n"
    "[[surface]]\nmaterial = \"red\"\nbox = { min = [-3, -9, -9], max = [-2, 9, 9] }\n";
/// Two units of it lie on the camera's way.
std::string box(Rgb absorption, Rgb scattering) {
    return fmt::format(
        "[[volume]]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1] }}\n"
        "sigma_a = [{}, {}, {}]\nsigma_s = [{}, {}, {}]\n",
        absorption[0], absorption[1], absorption[2], scattering[0], scattering[1], scattering[2]);
}

RenderResult featuresOf(const Scene& scene, int samples = 4096) {
    RenderSettings s;
    s.width = s.height = 8, s.endSample = samples;
    s.maxScatterings = 0;  // the picture itself does not matter
    s.layers.features = true;
    return render::render(scene, s);
}

/// Of all pixels, which are alike.
RgbEstimate albedoOf(const Film& film) {
    RgbEstimate e;
    for (int c = 0; c < 3; ++c) {
        Moments m;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x) m.add(film.albedo(x, y)[c]);
        e[static_cast<std::size_t>(c)] = Estimate(m);
    }
    return e;
}

/// Of a box and of what is behind it.
std::array<double, 3> expectedAlbedo(Rgb absorption, Rgb scattering, Rgb behind) {
    std::array<double, 3> a;
    for (int c = 0; c < 3; ++c) {
        const double t = double{absorption[c]} + scattering[c];
        const double passes = std::exp(-2 * t);
        a[static_cast<std::size_t>(c)] = scattering[c] / t * (1 - passes) + passes * behind[c];
    }
    return a;
}

TEST(FeatureLayers, AlbedoOfABoxAndOfWhatIsBehind) {
    const Rgb wall(0.8f, 0.3f, 0.1f);
    for (const auto& [absorption, scattering] :
         {std::pair{Rgb(0.3f), Rgb(0.2f)}, {Rgb(0.1f, 0.2f, 0.7f), Rgb(0.5f, 0.2f, 0.1f)}}) {
        const std::string medium = box(absorption, scattering);
        expectAgrees(albedoOf(featuresOf(sceneFrom(sky + medium + camera)).film),
                     expectedAlbedo(absorption, scattering, {}), 0.01);
        expectAgrees(albedoOf(featuresOf(sceneFrom(sky + medium + redWall + camera)).film),
                     expectedAlbedo(absorption, scattering, wall), 0.01);
    }
}

TEST(FeatureLayers, AlbedoOfOverlappingMediaIsThatOfTheirSums) {
    const Scene scene = sceneFrom(sky + box(Rgb(0.1f, 0.2f, 0.3f), Rgb(0.4f)) +
                                  box(Rgb(0.3f), Rgb(0.1f, 0.2f, 0.6f)) + camera);
    expectAgrees(albedoOf(featuresOf(scene).film),
                 expectedAlbedo({0.4f, 0.5f, 0.6f}, {0.5f, 0.6f, 1.0f}, {}), 0.01);
}

TEST(FeatureLayers, AlbedoOfSurfacesIsTheirReflectance) {
    const auto albedo = [&](const std::string& material) {
        const std::string wall = fmt::format(
            "[[material]]\nname = \"m\"\n{}\n"
            "[[surface]]\nmaterial = \"m\"\nbox = {{ min = [-3, -9, -9], max = [-2, 9, 9] }}\n",
            material);
        return featuresOf(sceneFrom(sky + wall + camera), 4).film.albedo(3, 3);
    };
    EXPECT_EQ(albedo("type = \"diffuse\"\ncolour = [0.8, 0.3, 0.1]"), Rgb(0.8f, 0.3f, 0.1f));
    EXPECT_EQ(albedo("type = \"conductor\"\ncolour = [0.9, 0.6, 0.2]"), Rgb(0.9f, 0.6f, 0.2f));
    EXPECT_EQ(albedo("type = \"dielectric\""), Rgb(1.0f));
    const std::string away = pencilCamera({5, 0.2, 0.1}, {1, 0, 0});
    EXPECT_EQ(featuresOf(sceneFrom(sky + redWall + away), 4).film.albedo(3, 3), Rgb(0.0f));
}

/// A ball of radius 1, densest in its middle, whose albedo is 0.75 where x < 0 and 0.25 elsewhere.
Scene ball(float scattering) {
    PlainGrid density, albedo;
    for (int z = -16; z < 16; z += 8)
        for (int y = -16; y < 16; y += 8)
            for (int x = -16; x < 16; x += 8) {
                density.setLeaf({x, y, z}, [](Vec3i v, int) {
                    return std::max(0.0f, 1 - static_cast<float>(length(v.as<double>())) / 10);
                });
                albedo.setLeaf({x, y, z}, [](Vec3i v, int) { return v.x < 0 ? 0.75f : 0.25f; });
            }
    MediumPart::Description d;
    d.field = std::make_shared<const Field>(density.field());
    d.albedo = std::make_shared<const Field>(albedo.field());
    d.worldFromIndex = d.albedoWorldFromIndex = Affine3d::scale({0.1, 0.1, 0.1});
    d.scattering = Rgb(scattering);
    return {{{MediumPart(d)}},
            LightSet({Environment(Rgb(1.0f), true)}),
            Camera::perspective({0, 0, 100}, {0, 0, 0}, {0, 1, 0}, 1)};
}

TEST(FeatureLayers, AlbedoOfAGridIsMetWithTheMatter) {
    const Film film = featuresOf(ball(2), 64).film;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            if (x == 3) continue;  // where the two albedos meet
            const float albedo = x < 4 ? 0.75f : 0.25f;
            EXPECT_NEAR(film.albedo(x, y)[1], albedo * (1 - film.transmittance(x, y)[1]), 1e-6f)
                << x << ", " << y;
        }
    EXPECT_GT(film.albedo(5, 4)[1], 0.1f);
}

TEST(FeatureLayers, NormalOfMatterPointsOut) {
    const Film film = featuresOf(ball(200), 64).film;
    for (const auto& [x, y] : {std::pair{1, 4}, {6, 4}, {4, 1}, {4, 6}, {2, 2}}) {
        // Of the sphere of which the ray meets the front, to the pixel and to the depth that it
        // reaches into the ball.
        const double right = (x + 0.5 - 4) / 4 * 100 * std::tan(pi / 360),
                     up = (4 - y - 0.5) / 4 * 100 * std::tan(pi / 360);
        const Vec3d front = {right, up, std::sqrt(1 - right * right - up * up)};
        const Vec3f n = film.normal(x, y);
        EXPECT_GT(dot(normalize(n.as<double>()), front), 0.95) << x << ", " << y;
        EXPECT_LE(length(n.as<double>()), 1 + 1e-6);
    }
}

/// Features look at the picture's own camera rays and change nothing of it.
TEST(FeatureLayers, ThePictureIsTheSame) {
    const Scene scene = ball(5);
    RenderSettings s;
    s.width = s.height = 8, s.endSample = 8;
    const Film without = render::render(scene, s).film;
    s.layers.features = true;
    const Film with = render::render(scene, s).film;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            EXPECT_EQ(with.radiance(x, y), without.radiance(x, y));
            EXPECT_EQ(without.albedo(x, y), Rgb(0.0f));
            EXPECT_EQ(without.at(x, y).depthSamples, 0u);
        }
}

}  // namespace
}  // namespace woodcock::test
