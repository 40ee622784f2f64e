// SPDX-License-Identifier: Apache-2.0
// Light of emissive surfaces, where it has a formula.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/oracle/surfaces.h"
#include "tests/support/expect_estimate.h"
#include "tests/support/render_scene.h"

namespace woodcock::test {
namespace {

const std::string lampMaterial =
    "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [3, 2, 1]\n";

TEST(EmissiveSurface, LightsTheGroundByItsFormFactor) {
    // A box of light above a ground of albedo 0.5; a point on it sees the lower face, and one more
    // where it stands aside.
    const Vec3d lower{-1, 2, -0.5}, upper{1, 4, 0.5};
    const std::string scene = lampMaterial +
                              "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.5\n"
                              "[[surface]]\nmaterial = \"grey\"\nplane = {}\n"
                              "[[surface]]\nmaterial = \"lamp\"\n"
                              "box = { min = [-1, 2, -0.5], max = [1, 4, 0.5] }\n";
    for (const double x : {0.0, 0.9, 3.0, 40.0}) {
        SCOPED_TRACE(x);
        const Vec3d point{x, 0, 0.2}, up{0, 1, 0};
        double irradiance = oracle::polygonIrradiance({lower,
                                                       {upper.x, lower.y, lower.z},
                                                       {upper.x, lower.y, upper.z},
                                                       {lower.x, lower.y, upper.z}},
                                                      point, up);
        if (x > upper.x)
            irradiance += oracle::polygonIrradiance({{upper.x, lower.y, lower.z},
                                                     {upper.x, upper.y, lower.z},
                                                     upper,
                                                     {upper.x, lower.y, upper.z}},
                                                    point, up);
        const double lit = 0.5 / pi * irradiance;
        const Scene s = sceneFrom(scene + pencilCamera(point + Vec3d{0, 1, 2}, {0, -1, -2}));
        const Film film = renderScene(s, {.width = 16, .height = 16, .samples = 256}).film;
        expectAgrees(evenRadiance(film), {3 * lit, 2 * lit, lit}, 0.004);
    }
}

TEST(EmissiveSurface, WallsThatShineAndReflectFillARoomEvenly) {
    const std::string scene =
        "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [3, 2, 1]\n"
        "both_sides = true\n"
        "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.8\n"
        "[[material]]\nname = \"wall\"\ntype = \"mix\"\nfirst = \"lamp\"\nsecond = \"grey\"\n"
        "weight = 0.75\n"
        "[[surface]]\nmaterial = \"wall\"\nbox = { min = [-1, -2, -0.5], max = [1, 4, 0.5] }\n";
    // Whatever scatters in there and absorbs nothing leaves it even.
    const std::string fog =
        "[[volume]]\nbox = { min = [-0.9, -1, -0.6], max = [2, 3.9, 0.4] }\n"
        "sigma_s = [2, 1, 0.3]\nsigma_a = 0\ng = 0.6\n";
    const double even = oracle::cavityRadiance(0.25, 0.75 * 0.8);
    const std::string camera = pencilCamera({0.3, 0.1, 0.2}, {1, 0.4, -0.2});
    for (const std::string& filling : {std::string(), fog}) {
        const Film film = renderScene(sceneFrom(scene + filling + camera),
                                      {.width = 16, .height = 16, .samples = 256})
                              .film;
        expectAgrees(evenRadiance(film), {3 * even, 2 * even, even}, 0.006);
    }
}

}  // namespace
}  // namespace woodcock::test
