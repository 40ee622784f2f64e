// SPDX-License-Identifier: Apache-2.0
// Local lights and discs, against quadrature and against each other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/expect_estimate.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace light;
using namespace proof;
using namespace render;

namespace {

double henyeyGreensteinByTheBook(double cosine, double g) {
    return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// Composite Simpson.
double integrate(const std::function<double(double)>& f, double a, double b, int steps = 20000) {
    double sum = f(a) + f(b);
    for (int i = 1; i < steps; ++i) sum += f(a + (b - a) * i / steps) * (i % 2 ? 4 : 2);
    return sum * (b - a) / steps / 3;
}

constexpr double sigmaA = 0.3, sigmaS = 0.7, sigmaT = sigmaA + sigmaS, half = 2;

/// A box of fog from -2 to 2.
std::string fog(double g) {
    return fmt::format(
        "[[volume]]\nbox = {{ min = [-2, -2, -2], max = [2, 2, 2] }}\n"
        "sigma_a = {}\nsigma_s = {}\ng = {}\n",
        sigmaA, sigmaS, g);
}
std::string point(Vec3d p, double power) {
    return fmt::format("[[light]]\ntype = \"point\"\nposition = [{}, {}, {}]\npower = {}\n", p.x,
                       p.y, p.z, power);
}
std::string sphere(Vec3d p, double radius, double power) {
    return fmt::format(
        "[[light]]\ntype = \"sphere\"\nposition = [{}, {}, {}]\nradius = {}\n"
        "power = {}\nvisible = false\n",
        p.x, p.y, p.z, radius, power);
}

RgbEstimate once(const std::string& scene, double x, double y, int samples) {
    return evenRadiance(renderScene(sceneFrom(scene + pencilCamera({x, y, 10}, {0, 0, -1})),
                                    {32, 32, samples, 0, 1})
                            .film);
}

/// A wide sphere is a cloud of points: single scattering by quadrature over the directions that hit
/// it, which next-event estimation and scattering find in shares.
TEST(SphereLight, OfAnySizeByQuadrature) {
    const Vec3d lightAt{1.5, 0, 0};
    const double radius = 0.8, radiance = 3;
    for (const double g : {0.0, 0.9, -0.6}) {
        // Seen from p on the line x = y = 0, the sphere fills a cone around its centre.
        const auto scattered = [&](double z) {
            const Vec3d p{0, 0, z}, axis = normalize(lightAt - p);
            const double distance = length(lightAt - p), across = axis.x;  // of the view, -z
            const double cosine = std::sqrt(1 - radius * radius / (distance * distance));
            return integrate(
                [&](double c) {
                    const double s = std::sqrt(1 - c * c);
                    // To the near side of the sphere, all of it in the fog's convex box.
                    const double path =
                        distance * c -
                        std::sqrt(std::max(0.0, radius * radius - distance * distance * s * s));
                    return std::exp(-sigmaT * (path + half - z)) *
                           integrate(
                               [&](double phi) {
                                   return henyeyGreensteinByTheBook(
                                       -axis.z * c + across * s * std::cos(phi), g);
                               },
                               0, 2 * pi, 64);
                },
                cosine, 1, 100);
        };
        // The half of the sphere beyond x = 2 is never the near side.
        const double exact = sigmaS * radiance * integrate(scattered, -half, half, 200);
        const std::string light = fmt::format(
            "[[light]]\ntype = \"sphere\"\nposition = [1.5, 0, 0]\nradius = {}\n"
            "radiance = {}\nvisible = false\n",
            radius, radiance);
        expectAgrees(once(fog(g) + light, 0, 0, 128), {exact, exact, exact}, 5e-3);
    }
}

TEST(SphereLight, IsSeenThroughTheFog) {
    const std::string light =
        "[[light]]\ntype = \"sphere\"\nposition = [0, 0, 1]\nradius = 0.25\nradiance = [1, 2, 3]\n";
    const Scene scene = sceneFrom(fog(0.5) + light + pencilCamera({0.1, 0, 10}, {0, 0, -1}));
    const double t = std::exp(-sigmaT * (1 - std::sqrt(0.25 * 0.25 - 0.01)));
    expectAgrees(evenRadiance(renderScene(scene, {8, 8, 16, 0, 0}).film), {t, 2 * t, 3 * t}, 1e-4);
}

/// Several local lights of both kinds at once: the choice among them changes no mean.
TEST(LocalLights, Add) {
    const std::string a = point({0.5, 0.5, 0}, 5), b = sphere({-1, 0, 1}, 0.3, 20),
                      c = point({0, 4, 0}, 300),
                      sun =
                          "[[light]]\ntype = \"sun\"\n"
                          "direction = [1, -1, 0]\nirradiance = 0.5\n";
    const auto many = [](const std::string& lights) {
        const std::string camera = pencilCamera({0, 0, 10}, {0, 0, -1});
        return evenRadiance(renderScene(sceneFrom(fog(0.4) + lights + camera), {32, 32, 128}).film);
    };
    double sum = 0, variance = 0;
    for (const std::string& light : {a, b, c, sun}) {
        const Estimate e = many(light)[0];
        sum += e.mean, variance += e.error * e.error;
    }
    expectAgree(many(a + b + c + sun)[0], {sum, std::sqrt(variance)}, 5e-3);
}

TEST(Sun, DiscByQuadrature) {
    // A disc 30 degrees wide above a slab of fog, seen from above; the fog scatters forwards.
    const double depth = sigmaT * 2 * half, irradiance = 1;
    const double halfAngle = 15 * pi / 180;
    for (const double g : {0.0, 0.9}) {
        const Vec3d towards = normalize(Vec3d{0, -0.3, -1});  // the sun is below: light goes up
        Vec3d s, t;
        orthonormalBasis(towards, s, t);
        const double radiance = irradiance / (pi * std::sin(halfAngle) * std::sin(halfAngle));
        const auto throughSlab = [&](Vec3d d) {  // seen along -z; the box is a slab: wide sides
            const double mu0 = -d.z;
            return std::abs(1 - mu0) < 1e-9
                       ? depth * std::exp(-depth)
                       : mu0 / (mu0 - 1) * (std::exp(-depth / mu0) - std::exp(-depth));
        };
        const double exact =
            sigmaS / sigmaT * radiance *
            integrate(
                [&](double c) {
                    const double sine = std::sqrt(1 - c * c);
                    return integrate(
                        [&](double phi) {
                            const Vec3d d = s * (sine * std::cos(phi)) +
                                            t * (sine * std::sin(phi)) + towards * c;
                            return henyeyGreensteinByTheBook(-d.z, g) * throughSlab(d);
                        },
                        0, 2 * pi, 200);
                },
                std::cos(halfAngle), 1, 200);
        const Scene scene = sceneFrom(
            fmt::format("[[volume]]\nbox = {{ min = [-1e6, -1e6, -2], max = [1e6, 1e6, 2] }}\n"
                        "sigma_a = {}\nsigma_s = {}\ng = {}\n"
                        "[[light]]\ntype = \"sun\"\nirradiance = {}\nangular_diameter = 30\n"
                        "direction = [{}, {}, {}]\n",
                        sigmaA, sigmaS, g, irradiance, -towards.x, -towards.y, -towards.z) +
            pencilCamera({0, 0, 10}, {0, 0, -1}));
        expectAgrees(evenRadiance(renderScene(scene, {32, 32, 768, 0, 1}).film),
                     {exact, exact, exact}, 5e-3);
    }
}

}  // namespace
}  // namespace woodcock::test
