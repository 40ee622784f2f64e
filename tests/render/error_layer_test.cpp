// SPDX-License-Identifier: Apache-2.0
// The claim of the error layer, against renders of many more samples.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/paths.h"
#include "tests/support/peer_scene.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;
using namespace render;

namespace {

struct Claim {
    double inside = 0;  ///< share of pixels and channels whose error is within two standard errors
    double z = 0;       ///< root mean square of error / standard error
};

/// Of renders with `samples`, one for each seed. Pixels without any variance are left out.
Claim claimOf(const Scene& scene, Picture picture, const Film& reference, int seeds) {
    Moments inside, square;
    for (int i = 0; i < seeds; ++i, ++picture.seed) {
        const Film film = renderScene(scene, picture).film;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                for (int c = 0; c < 3; ++c) {
                    const double error = film.standardError(x, y)[c];
                    const double off = film.radiance(x, y)[c] - reference.radiance(x, y)[c];
                    if (error == 0 && off == 0) continue;
                    const double z = off / std::hypot(error, reference.standardError(x, y)[c]);
                    inside.add(std::abs(z) <= 2);
                    square.add(z * z);
                }
    }
    return {inside.mean(), std::sqrt(square.mean())};
}

void expectHonest(const Scene& scene, const std::vector<int>& counts, Picture reference,
                  double leastZ = 0.5) {
    const Film truth = renderScene(scene, reference).film;
    for (const int samples : counts) {
        SCOPED_TRACE(testing::Message() << samples << " samples");
        Picture picture = reference;
        picture.samples = samples, picture.seed = 0;
        const Claim claim = claimOf(scene, picture, truth, 1024 / samples + 4);
        EXPECT_GE(claim.inside, 0.95);
        // Nor is it claimed to be much larger than it is.
        EXPECT_GT(claim.z, leastZ);
        EXPECT_LT(claim.z, 1.1);
    }
}

constexpr int many = 8192;

/// Where no chance decides whether camera rays scatter, Sobol points halve the error. The layer
/// takes samples for independent, and does not know.
TEST(ErrorLayer, IsHonestOfThinSmoke) {
    if (!std::filesystem::exists(sharedDir())) GTEST_SKIP() << "no " << sharedDir();
    expectHonest(peerScene("thin"), {16, 64, 256},
                 {.width = 16, .height = 16, .samples = many, .seed = 1000}, 0.4);
}

/// Unlimited orders take long to make a reference of: 20 of them are as noisy.
TEST(ErrorLayer, IsHonestOfADenseCloud) {
    if (!std::filesystem::exists(sharedDir())) GTEST_SKIP() << "no " << sharedDir();
    expectHonest(
        peerScene("cloud"), {16, 64},
        {.width = 16, .height = 16, .samples = many / 4, .seed = 1000, .maxScatterings = 20});
}

TEST(ErrorLayer, IsHonestOfALocalLightInFog) {
    expectHonest(sceneFrom("[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
                           "sigma_a = 0.1\nsigma_s = 1\n"
                           "[[light]]\ntype = \"point\"\nposition = [0.3, 0.4, 0]\n"
                           "[camera]\neye = [0, 0.5, 4]\nlook_at = [0, 0, 0]\n"),
                 {16, 64, 256}, {.width = 16, .height = 16, .samples = many, .seed = 1000});
}

TEST(ErrorLayer, IsHonestOfMilkInGlass) {
    expectHonest(
        sceneFrom("[[material]]\nname = \"glass\"\ntype = \"dielectric\"\n"
                  "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.5\n"
                  "[[surface]]\nmaterial = \"glass\"\nsphere = { centre = [0, 1, 0], radius = 1 }\n"
                  "medium = { sigma_a = 0.2, sigma_s = 1 }\n"
                  "[[surface]]\nmaterial = \"grey\"\nplane = {}\n"
                  "[[light]]\ntype = \"sphere\"\nposition = [3, 4, 2]\nradius = 1\nradiance = 10\n"
                  "[[light]]\ntype = \"environment\"\nradiance = 0.5\n"
                  "[camera]\neye = [0, 2, 6]\nlook_at = [0, 0.8, 0]\nfov = 35\n"),
        {16, 64, 256}, {.width = 12, .height = 12, .samples = many / 2, .seed = 1000});
}

}  // namespace
}  // namespace woodcock::test
