// SPDX-License-Identifier: Apache-2.0
// From a scattering order on, isotropic media of equal transport coefficient.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/medium/media.h"
#include "tests/support/expect_error.h"
#include "tests/support/expect_estimate.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/render/approximate_media.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

/// Everything that draws random numbers, in overlapping fog; with `surfaces` also over a ground,
/// beside a ball of cloudy glass.
Scene fog(double g, bool surfaces) {
    std::string text = fmt::format(
        "[[volume]]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1] }}\n"
        "sigma_a = 0.1\nsigma_s = [1, 2, 0.5]\ng = {0}\nemission = 0.1\n"
        "[[volume]]\nbox = {{ min = [-2, -0.5, -1], max = [0.5, 0.5, 1] }}\n"
        "sigma_a = 0\nsigma_s = 3\ng = {0}\n"
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, 0]\nangular_diameter = 5\n"
        "[[light]]\ntype = \"point\"\nposition = [0.2, 0.3, 0.1]\n"
        "[[light]]\ntype = \"sphere\"\nposition = [-0.5, 0.2, 0]\nradius = 0.1\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.3\n"
        "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 30\n",
        g);
    if (surfaces)
        text += fmt::format(
            "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.5\n"
            "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.3\n"
            "[[surface]]\nmaterial = \"grey\"\nbox = {{ min = [-9, -2, -9], max = [9, -1.5, 9] }}\n"
            "[[surface]]\nmaterial = \"glass\"\nsphere = {{ centre = [0.7, 0, 1], radius = 0.6 }}\n"
            "medium = {{ sigma_a = 0.1, sigma_s = 4, g = {} }}\n",
            g);
    return sceneFrom(text);
}

RenderResult draw(const Scene& scene, std::optional<int> after, RenderSettings s = {}) {
    s.width = 24, s.height = 16, s.endSample = 8;
    s.layers.depth = true;
    s.approximations.similarityAfter = after;
    return render::render(scene, s);
}

void expectSameBits(const Film& a, const Film& b) {
    const Film::Window crop = a.crop();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x)
            for (int c = 0; c < 3; ++c) {
                ASSERT_EQ(a.at(x, y).radiance[c], b.at(x, y).radiance[c]) << x << ", " << y;
                ASSERT_EQ(a.at(x, y).transmittance[c], b.at(x, y).transmittance[c]);
            }
}

class Similar : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Surfaces, Similar, testing::Bool());

TEST_P(Similar, AfterAllOrdersChangesNoBit) {
    const Scene scene = fog(0.7, GetParam());
    expectSameBits(draw(scene, 1'000'000).film, draw(scene, {}).film);
}

TEST_P(Similar, OfIsotropicMediaChangesNoBit) {
    const Scene scene = fog(0, GetParam());
    const RenderResult unreduced = draw(scene, {});
    for (const int after : {0, 1, 3}) expectSameBits(draw(scene, after).film, unreduced.film);
}

TEST_P(Similar, ThreadsAndNeighboursDoNotShow) {
    const Scene scene = fog(0.7, GetParam());
    RenderSettings one, other;
    one.threads = 1;
    other.threads = 3;
    other.crop = Film::Window{5, 3, 20, 12};
    expectSameBits(draw(scene, 2, other).film, draw(scene, 2, one).film);
}

TEST_P(Similar, ChangesWhatItShould) {
    const Scene scene = fog(0.7, GetParam());
    const RenderResult a = draw(scene, 1), b = draw(scene, {});
    EXPECT_NE(a.film.at(12, 8).radiance[0], b.film.at(12, 8).radiance[0]);
}

/// With k = 0 every path is one of the reduced slab: its reflectance, without any bias of its own,
/// for a beam at normal incidence (see slab_test.cpp). Held by a volume, or by a surface.
struct Row {
    double depth, albedo, g;
    bool interior;
    int samples;
};
void PrintTo(const Row& r, std::ostream* out) {
    *out << "g = " << r.g << ", depth " << r.depth << ", albedo " << r.albedo
         << (r.interior ? ", interior" : "");
}
class SimilarSlab : public testing::TestWithParam<Row> {};
INSTANTIATE_TEST_SUITE_P(AddingDoubling, SimilarSlab,
                         testing::Values(Row{100, 1, 0.85, false, 64}, Row{4, 0.9, 0.6, false, 32},
                                         Row{2, 0.95, -0.5, false, 32},
                                         Row{4, 0.9, 0.6, true, 32}));

oracle::Face answer(double depth, double albedo, double g) {
    return oracle::solveSlab({{{depth, albedo, g}}}, {1}).above;
}

TEST_P(SimilarSlab, FromTheCameraOnIsTheReducedOneExactly) {
    const Row& row = GetParam();
    const proof::Lab lab({});
    proof::writeTwoColouredSky(lab);
    const std::string box = "box = { min = [-1e6, 0, -1e6], max = [1e6, 1, 1e6] }\n";
    const std::string sigma =
        fmt::format("scale = {}, albedo = {}, g = {}", row.depth, row.albedo, row.g);
    std::string medium;
    if (row.interior)
        medium =
            "[[material]]\nname = \"air\"\ntype = \"interface\"\n[[surface]]\nmaterial = "
            "\"air\"\n" +
            box + "medium = { " + sigma + " }\n";
    else
        medium = fmt::format("[[volume]]\n{}scale = {}\nalbedo = {}\ng = {}\n", box, row.depth,
                             row.albedo, row.g);
    const Scene scene = proof::sceneIn(lab, medium + proof::twoColouredSky + proof::cameraAbove(1));
    RenderSettings settings;
    settings.width = settings.height = 32, settings.endSample = row.samples;
    settings.approximations.similarityAfter = 0;
    const RgbEstimate seen = evenRadiance(render::render(scene, settings).film);
    const double scattering = row.albedo * (1 - row.g), absorption = 1 - row.albedo;
    const double extinction = scattering + absorption;
    const oracle::Face expected = answer(row.depth * extinction, 1 - absorption / extinction, 0);
    expectAgrees(seen[0], expected.reflectance[0], 1e-2);
    expectAgrees(seen[2], expected.transmittance[0], 2e-2);
    if (row.depth > 10) return;
    // The test can tell: the slab itself answers otherwise.
    const double unreduced = answer(row.depth, row.albedo, row.g).transmittance[0];
    EXPECT_GT(std::abs(unreduced - expected.transmittance[0]), 4 * seen[2].error);
}

TEST(Similarity, IsNotMarchedThroughAlbedoGrids) {
    Scene scene = fog(0, false);
    scene.medium = chromaticMedium().medium();
    RenderSettings settings;
    settings.width = settings.height = 2, settings.endSample = 1;
    settings.approximations.similarityAfter = 0;
    EXPECT_NO_THROW(render::render(scene, settings));
    settings.approximations.marchStep = 1;
    expectError(ErrorKind::Usage, "march_step cannot be used together with similarity",
                [&] { render::render(scene, settings); });
}

/// What similarity costs a thick conservative slab is little, by tables alone.
TEST(SimilarSlab, IsNearlyTheSlabWhereItIsThick) {
    const oracle::Face slab = answer(100, 1, 0.85), reduced = answer(15, 1, 0);
    EXPECT_NEAR(reduced.reflectance[0], slab.reflectance[0], 0.02 * slab.reflectance[0]);
    EXPECT_NEAR(reduced.transmittance[0], slab.transmittance[0], 0.05 * slab.transmittance[0]);
}

/// From a later order on it is nearer to the truth.
TEST(SimilarSlab, IsBetterTheLaterItComes) {
    constexpr double depth = 10, g = 0.85;
    const proof::Lab lab({});
    proof::writeTwoColouredSky(lab);
    const Scene scene = proof::sceneIn(
        lab, fmt::format("[[volume]]\nbox = {{ min = [-1e6, 0, -1e6], max = [1e6, 1, 1e6] }}\n"
                         "scale = {}\nalbedo = 1\ng = {}\n{}{}",
                         depth, g, proof::twoColouredSky, proof::cameraAbove(1)));
    const double truth = answer(depth, 1, g).reflectance[0];
    RenderSettings settings;
    settings.width = settings.height = 32, settings.endSample = 96;
    settings.approximations.similarityAfter = 16;
    const Estimate late = evenRadiance(render::render(scene, settings).film)[0];
    EXPECT_LT(late.error, 0.005 * truth);
    const double atOnce = answer(depth * (1 - g), 1, 0).reflectance[0];
    EXPECT_LT(std::abs(late.mean - truth) + 4 * late.error, std::abs(atOnce - truth));
}

}  // namespace
}  // namespace woodcock::test
