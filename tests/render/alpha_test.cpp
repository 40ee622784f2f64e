// SPDX-License-Identifier: Apache-2.0
// Alpha where hardly anything, or hardly nothing, comes through.
#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace image;
using namespace proof;

namespace {

const std::string around =
    "[[light]]\ntype = \"environment\"\n"
    "[camera]\ntype = \"orthographic\"\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\nheight = 0.5\n";

void expectAlpha(const std::string& scene, double depth) {
    const Film film =
        renderScene(sceneFrom(scene + around), {.width = 4, .height = 4, .samples = 2}).film;
    const double expected = -std::expm1(-depth);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) EXPECT_NEAR(film.alpha(x, y), expected, 1e-6 * expected);
}

std::string fog(double from, double to, const std::string& absorption) {
    return "[[volume]]\nbox = { min = [-1, -1, " + std::to_string(from) + "], max = [1, 1, " +
           std::to_string(to) + "] }\nsigma_s = 0\nsigma_a = " + absorption + "\n";
}

TEST(Alpha, KeepsTheDigitsOfSmallDepths) {
    for (const char* depth : {"1e-12", "1e-9", "1e-7", "1e-4", "1e-3", "0.1", "3"}) {
        expectAlpha(fog(-1, 0, depth), std::stod(depth));
        // Two that overlap, and a colour, of whose channels alpha is the mean.
        expectAlpha(fog(-1, 0, depth) + fog(-1, 1, depth), 3 * std::stod(depth));
        expectAlpha(fog(-1, 0, std::string("[") + depth + ", " + depth + ", " + depth + "]"),
                    std::stod(depth));
    }
}

TEST(Alpha, KeepsThemAmongSurfaces) {
    for (const char* depth : {"1e-12", "1e-9", "1e-7", "1e-3", "3"})
        expectAlpha(
            fog(-1, 0, depth) +
                "[[material]]\nname = \"fog\"\ntype = \"interface\"\n"
                "[[surface]]\nmaterial = \"fog\"\nbox = { min = [-1, -1, 1], max = [1, 1, 2] }\n"
                "medium = { sigma_a = " +
                depth + ", sigma_s = 0 }\n",
            2 * std::stod(depth));
}

}  // namespace
}  // namespace woodcock::test
