// SPDX-License-Identifier: Apache-2.0
// Glass against what Fresnel and Beer say of plates, and half-spaces behind glass.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/oracle/plates.h"
#include "tests/oracle/surfaces.h"
#include "tests/support/expect_estimate.h"
#include "tests/support/render_scene.h"

namespace woodcock::test {
namespace {

std::string glass(double index) {
    return fmt::format("[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = {}\n", index);
}
const std::string sky = "[[light]]\ntype = \"environment\"\nradiance = 1\n";

/// A camera above, at this cosine to the vertical, that looks at the origin.
std::string cameraAt(double mu) {
    const double sine = std::sqrt(1 - mu * mu);
    return pencilCamera({-5 * sine, 5 * mu + 1, 0}, {sine, -mu, 0});
}

// The sky of radiance 1 is seen by reflection, and by transmission a ground that shines in three
// strengths.
TEST(Plate, ReflectsAndTransmitsByFresnelAndBeer) {
    const std::string ground =
        "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [0, 1, 5]\n"
        "[[surface]]\nmaterial = \"lamp\"\nplane = { size = [4000, 4000] }\n"
        "transform = { translate = [0, -2, 0] }\n";
    for (const double index : {1.33, 2.4})
        for (const double mu : {1.0, 0.5, 0.1}) {
            SCOPED_TRACE(testing::Message() << index << ' ' << mu);
            const double sigma = 0.4, thickness = 0.8;
            const std::string plate =
                glass(index) + fmt::format(
                                   "[[surface]]\nmaterial = \"glass\"\n"
                                   "box = {{ min = [-1000, {}, -1000], max = [1000, 1, 1000] }}\n"
                                   "medium = {{ sigma_a = {}, sigma_s = 0 }}\n",
                                   1 - thickness, sigma);
            const Scene scene = sceneFrom(plate + ground + sky + cameraAt(mu));
            const auto answer = oracle::unpolarisedPlates({{index, sigma * thickness}}, mu);
            const double R = answer.reflectance, T = answer.transmittance;
            const Film film = renderScene(scene, {.width = 16, .height = 16, .samples = 512}).film;
            expectAgrees(evenRadiance(film), {R, R + T, R + 5 * T}, 0.015);
        }
}

TEST(Plate, HalfSpacesBehindGlassAreGiovanellis) {
    const std::string body =
        "[[surface]]\nmaterial = \"glass\"\n"
        "box = { min = [-1000, -1000, -1000], max = [1000, 1, 1000] }\n"
        "medium = { sigma_s = 0.9, sigma_a = 0.1 }\n";
    for (const double mu : {1.0, 0.4}) {
        SCOPED_TRACE(mu);
        const double expected = oracle::refractiveHalfSpaceReflectance(1.5, 0.9, 0, mu);
        const Scene scene = sceneFrom(glass(1.5) + body + sky + cameraAt(mu));
        const Film film = renderScene(scene, {.width = 16, .height = 16, .samples = 512}).film;
        expectAgrees(evenRadiance(film), {expected, expected, expected}, 0.005);
    }
}

}  // namespace
}  // namespace woodcock::test
