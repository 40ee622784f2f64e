// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/view_cube.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/environment_variable.h"
#include "woodcock/base/random.h"

namespace woodcock::test {

using namespace image;

namespace {

/// As a page's script interpolates.
std::array<double, 3> lookUp(const ViewCube& cube, const std::array<float, 3>& rgb) {
    std::array<int, 3> cell{};
    std::array<double, 3> within{}, sum{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double at = (std::log2(rgb[c] + std::exp2(cube.low)) - cube.low) /
                          (cube.high - cube.low) * (cube.side - 1);
        cell[c] = std::clamp(static_cast<int>(at), 0, cube.side - 2);
        within[c] = std::clamp(at - cell[c], 0.0, 1.0);
    }
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        std::array<int, 3> node{};
        for (std::size_t c = 0; c < 3; ++c) {
            const int up = corner >> c & 1;
            node[c] = cell[c] + up;
            weight *= up ? within[c] : 1 - within[c];
        }
        const auto at =
            static_cast<std::size_t>(3 * (node[0] + cube.side * (node[1] + cube.side * node[2])));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * cube.rgb[at + c];
    }
    return sum;
}

TEST(ViewCube, IsTheViewToTwoCodes) {
    const EnvironmentVariable none("OCIO", {});
    const ColorConfig config;
    for (const std::string& view : config.views()) {
        if (view == "Raw") continue;
        DisplaySettings settings;
        settings.view = view;
        const DisplayTransform transform = config.displayTransform(settings);
        const ViewCube cube = bakeView(transform);
        ASSERT_EQ(cube.rgb.size(), static_cast<std::size_t>(3 * 33 * 33 * 33));
        RandomStream random(1);
        double squares = 0;
        for (int i = 0; i < 2000; ++i) {
            std::array<float, 3> rgb{};
            const double stops = -8 + 10 * random.uniform();
            for (float& v : rgb)
                v = static_cast<float>(std::exp2(stops) * (0.2 + 0.8 * random.uniform()));
            float pixel[4] = {rgb[0], rgb[1], rgb[2], 1};
            transform.apply(pixel);
            const std::array<double, 3> found = lookUp(cube, rgb);
            for (std::size_t c = 0; c < 3; ++c)
                squares += std::pow(found[c] - 255 * std::clamp(pixel[c], 0.0f, 1.0f), 2);
        }
        EXPECT_LT(std::sqrt(squares / 6000), 2) << view;
    }
}

TEST(ViewCube, BlackIsTheFirstNode) {
    const EnvironmentVariable none("OCIO", {});
    DisplaySettings settings;
    settings.view = "Standard";
    const ViewCube cube = bakeView(ColorConfig().displayTransform(settings));
    EXPECT_EQ(cube.rgb[0], 0);
    EXPECT_EQ(cube.rgb.back(), 255);
}

}  // namespace
}  // namespace woodcock::test
