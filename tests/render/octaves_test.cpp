// SPDX-License-Identifier: Apache-2.0
// Multiple scattering as octaves of single scattering.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "tests/support/expect_estimate.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/oracles/phase_functions.h"
#include "woodcock/proof/oracles/quadrature.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace proof;
using namespace render;

namespace {

const std::string camera = "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 30\n";

RgbEstimate mean(const Scene& scene, int octaves, std::optional<int> maxScatterings, int samples,
                 std::uint64_t firstSeed) {
    std::array<Moments, 3> m;
    for (std::uint64_t seed = firstSeed; seed < firstSeed + 16; ++seed) {
        RenderSettings s;
        s.width = s.height = 16, s.endSample = samples, s.seed = seed;
        s.maxScatterings = maxScatterings;
        s.approximations.octaves = octaves;
        const RgbEstimate e = evenRadiance(render::render(scene, s).film);
        for (std::size_t c = 0; c < 3; ++c) m[c].add(e[c].mean);
    }
    return {Estimate(m[0]), Estimate(m[1]), Estimate(m[2])};
}

/// Every kind of light, with the events and the flights that find it.
TEST(Octaves, OneIsSingleScattering) {
    const Scene scene = sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
        "sigma_a = 0.1\nsigma_s = [1, 2, 0.5]\ng = 0.5\nemission = [0.1, 0, 0.2]\n"
        "[[volume]]\nbox = { min = [-1, -0.5, -1], max = [0.5, 0.5, 1] }\n"
        "sigma_a = 0\nsigma_s = 1\ng = -0.3\n"
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, 0]\nangular_diameter = 5\n"
        "[[light]]\ntype = \"point\"\nposition = [0.2, 0.3, 0.1]\n"
        "[[light]]\ntype = \"sphere\"\nposition = [-0.5, 0.2, 0]\nradius = 0.1\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.3\n" +
        camera);
    expectAgree(mean(scene, 1, {}, 64, 100), mean(scene, 0, 1, 64, 200), 5e-3);
}

// A slab 1 high, and a beam at this cosine to its normal that comes from above.
constexpr double depth = 3, albedo = 0.9, g = 0.7, irradiance = 2;

std::string slab(bool interior) {
    const std::string box = "box = { min = [-1e6, 0, -1e6], max = [1e6, 1, 1e6] }\n";
    const std::string sigma = fmt::format("scale = {}\nalbedo = {}\ng = {}\n", depth, albedo, g);
    if (!interior) return "[[volume]]\n" + box + sigma;
    return "[[material]]\nname = \"air\"\ntype = \"interface\"\n[[surface]]\nmaterial = \"air\"\n" +
           box + fmt::format("medium = {{ scale = {}, albedo = {}, g = {} }}\n", depth, albedo, g);
}

/// Octave i of the light at optical depth t is a^i exp(-b^i t / mu), which the eye sees through
/// exp(-t): the integral over t has a form. Light that is seen below came through the rest.
TEST(Octaves, OfASlabInTheSunHaveAForm) {
    constexpr double mu = 0.6;
    const auto sun = fmt::format(
        "[[light]]\ntype = \"sun\"\ndirection = [0.8, -{}, 0]\n"
        "irradiance = [{}, 1, 0]\n",
        mu, irradiance);
    for (const int octaves : {1, 3, 6}) {
        double above = 0, below = 0, amount = 1;
        for (int i = 0; i < octaves; ++i, amount /= 2) {
            const double k = amount / mu, p = albedo * irradiance * amount;
            above += p * oracle::henyeyGreenstein(-mu, g * amount) * -std::expm1(-depth * (1 + k)) /
                     (1 + k);
            below += p * oracle::henyeyGreenstein(mu, g * amount) * std::exp(-depth) *
                     std::expm1(depth * (1 - k)) / (1 - k);
        }
        for (const bool interior : {false, true}) {
            const auto seen = [&](double y, double towards) {
                const Scene scene =
                    sceneFrom(slab(interior) + sun + pencilCamera({0, y, 0}, {0, towards, 0}));
                return mean(scene, octaves, {}, 64, 1);
            };
            SCOPED_TRACE(testing::Message() << octaves << (interior ? ", interior" : ""));
            expectAgrees(seen(3, -1), {above, above / 2, 0}, 1e-2);
            expectAgrees(seen(-3, 1), {below, below / 2, 0}, 1e-2);
        }
    }
}

/// The same of Draine's function: octave i is mixed with isotropic scattering, c^i of it is left.
TEST(Octaves, OfOtherPhaseFunctionsAreMixedWithIsotropicScattering) {
    constexpr double mu = 0.6;
    constexpr int octaves = 3;
    double above = 0, below = 0, amount = 1;
    const auto phase = [&](double cosine) {
        return amount * oracle::draine(cosine, 0.6, 5) + (1 - amount) / (4 * pi);
    };
    for (int i = 0; i < octaves; ++i, amount /= 2) {
        const double k = amount / mu, p = albedo * irradiance * amount;
        above += p * phase(-mu) * -std::expm1(-depth * (1 + k)) / (1 + k);
        below += p * phase(mu) * std::exp(-depth) * std::expm1(depth * (1 - k)) / (1 - k);
    }
    const auto seen = [&](double y, double towards) {
        return mean(sceneFrom(fmt::format("[[volume]]\n"
                                          "box = {{ min = [-1e6, 0, -1e6], max = [1e6, 1, 1e6] }}\n"
                                          "scale = {}\nalbedo = {}\n"
                                          "phase = {{ type = \"draine\", g = 0.6, alpha = 5 }}\n"
                                          "[[light]]\ntype = \"sun\"\ndirection = [0.8, -{}, 0]\n"
                                          "irradiance = [{}, 1, 0]\n",
                                          depth, albedo, mu, irradiance) +
                              pencilCamera({0, y, 0}, {0, towards, 0})),
                    octaves, {}, 64, 1);
    };
    expectAgrees(seen(3, -1), {above, above / 2, 0}, 1e-2);
    expectAgrees(seen(-3, 1), {below, below / 2, 0}, 1e-2);
}

/// What no light sampling finds: the flight after the event does.
TEST(Octaves, AreLitByAConstantSky) {
    constexpr int octaves = 4;
    const oracle::Quadrature q = oracle::gaussLegendre(48);
    double expected = std::exp(-depth);  // straight through
    const auto over = [&](double a, double b, auto&& f) {
        double sum = 0;
        for (std::size_t i = 0; i < q.nodes.size(); ++i)
            sum += q.weights[i] * f(a + (b - a) * q.nodes[i]);
        return sum * (b - a);
    };
    double amount = 1;
    for (int i = 0; i < octaves; ++i, amount /= 2)
        expected +=
            amount * albedo * over(0, depth, [&](double t) {
                // Directions by cosine, up and down; the eye looks down. Cubed, so that what is
                // crowded at the horizon is smooth.
                return std::exp(-t) * over(0, 1, [&](double s) {
                           const double mu = s * s * s, b = amount;
                           return 3 * s * s * 2 * pi *
                                  ((oracle::henyeyGreenstein(-mu, 0) * std::exp(-b * t / mu)) +
                                   (oracle::henyeyGreenstein(mu, 0) *
                                    std::exp(-b * (depth - t) / mu)));
                       });
            });
    const Scene scene = sceneFrom(
        fmt::format("[[volume]]\nbox = {{ min = [-1e6, 0, -1e6], max = [1e6, 1, 1e6] }}\n"
                    "scale = {}\nalbedo = {}\n[[light]]\ntype = \"environment\"\nradiance = 1\n",
                    depth, albedo) +
        pencilCamera({0, 3, 0}, {0, -1, 0}));
    expectAgrees(mean(scene, octaves, {}, 64, 1), {expected, expected, expected}, 5e-3);
}

/// Near a local light the event and the equiangular point share the light.
TEST(Octaves, AroundALocalLightByQuadrature) {
    constexpr int octaves = 3;
    constexpr double sigmaA = 0.3, sigmaS = 0.7, sigmaT = sigmaA + sigmaS, power = 4 * pi;
    const Vec3d lamp{0.5, 0, 0.3};
    const oracle::Quadrature q = oracle::gaussLegendre(200);
    double expected = 0;
    for (std::size_t k = 0; k < q.nodes.size(); ++k) {
        const double t = 4 * q.nodes[k];  // from z = 2 to -2
        const Vec3d to = lamp - Vec3d{0, 0, 2 - t};
        const double r = length(to), cosine = -to.z / r;
        double amount = 1;
        for (int i = 0; i < octaves; ++i, amount /= 2)
            expected += 4 * q.weights[k] * std::exp(-sigmaT * t) * amount * sigmaS *
                        oracle::henyeyGreenstein(cosine, g * amount) * power / (4 * pi) *
                        std::exp(-amount * sigmaT * r) / (r * r);
    }
    const Scene scene =
        sceneFrom(fmt::format("[[volume]]\nbox = {{ min = [-2, -2, -2], max = [2, 2, 2] }}\n"
                              "sigma_a = {}\nsigma_s = {}\ng = {}\n"
                              "[[light]]\ntype = \"point\"\nposition = [{}, {}, {}]\npower = {}\n",
                              sigmaA, sigmaS, g, lamp.x, lamp.y, lamp.z, power) +
                  pencilCamera({0, 0, 10}, {0, 0, -1}));
    expectAgrees(mean(scene, octaves, {}, 64, 1), {expected, expected, expected}, 1e-2);
}

TEST(Octaves, TouchNoSurfaces) {
    const Scene scene = sceneFrom(
        "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.5\n"
        "[[surface]]\nmaterial = \"grey\"\nbox = { min = [-9, -2, -9], max = [9, -1.5, 9] }\n"
        "[[surface]]\nmaterial = \"grey\"\nsphere = { centre = [0.7, 0, 1], radius = 0.6 }\n"
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, 0]\nangular_diameter = 5\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.3\n" +
        camera);
    const RgbEstimate with = mean(scene, 3, {}, 4, 1), without = mean(scene, 0, {}, 4, 1);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(with[c].mean, without[c].mean);
}

TEST(Octaves, ContradictSimilarity) {
    const Scene scene = sceneFrom(slab(false) + camera);
    RenderSettings s;
    s.approximations.octaves = 2;
    s.approximations.similarityAfter = 3;
    expectError(ErrorKind::Usage, "octaves and similarity exclude each other",
                [&] { render::render(scene, s); });
}

}  // namespace
}  // namespace woodcock::test
