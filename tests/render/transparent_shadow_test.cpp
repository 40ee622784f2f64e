// SPDX-License-Identifier: Apache-2.0
// Light on a ground below a plate of absorbing glass, by either choice of shadows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/plates.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace proof;
using namespace render;

namespace {

constexpr double sigma = 0.3, irradiance = 2, albedo = 0.5;
constexpr double open = albedo / pi * irradiance;  // radiance of the ground without the plate

RgbEstimate ground(const std::string& sun, bool transparent, int samples) {
    Scene scene = sceneFrom(
        fmt::format("[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = {}\n"
                    "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.5\n"
                    "[[surface]]\nmaterial = \"grey\"\ndisk = {{ radius = 0.01 }}\n"
                    "[[surface]]\nmaterial = \"glass\"\n"
                    "box = {{ min = [-100, 1, -100], max = [100, 2, 100] }}\n"
                    "medium = {{ sigma_a = {}, sigma_s = 0 }}\n"
                    "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0]\nirradiance = {}\n{}\n{}",
                    albedo, sigma, irradiance, sun, pencilCamera({0.5, 0.5, 0}, {-1, -1, 0})));
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.endSample = samples;
    settings.approximations.transparentShadows = transparent;
    return evenRadiance(render::render(scene, settings).film);
}

TEST(TransparentShadows, GoStraightThroughBothFaces) {
    const double face = 1 - oracle::fresnelReflectance(1, 1.5);
    const double expected = open * face * face * std::exp(-sigma);
    const auto e = ground("", true, 4);
    for (const Estimate& channel : e) EXPECT_NEAR(channel.mean, expected, 1e-5 * expected);
}

TEST(TransparentShadows, HonestOnesStopLightOfNoSize) {
    EXPECT_EQ(ground("", false, 4)[0].mean, 0);
}

/// A sun that rays can find: honest paths also count what goes to and fro in the plate, transparent
/// shadows leave that out, and neither counts what the other brings.
TEST(TransparentShadows, AreDarkerByTheReflectionsInThePlate) {
    const std::string disc = "angular_diameter = 8";
    const double honest = open * oracle::unpolarisedPlates({{1.5, sigma}}, 1).transmittance;
    const double face = 1 - oracle::fresnelReflectance(1, 1.5);
    // Within the disc's 4 degrees path lengths and Fresnel change by less than 0.3 %.
    const auto agrees = [](Estimate e, double truth) {
        EXPECT_NEAR(e.mean, truth, 4 * e.error + 3e-3 * truth);
        EXPECT_LT(e.error, 0.02 * truth);
    };
    agrees(ground(disc, false, 4096)[1], honest);
    agrees(ground(disc, true, 256)[1], open * face * face * std::exp(-sigma));
}

}  // namespace
}  // namespace woodcock::test
