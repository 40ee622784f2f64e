// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/even_light.h"

#include <gtest/gtest.h>

namespace woodcock::test {

using namespace light;

namespace {

/// An image of two pixels: the radiance is `left` and `right` far from the seams between them, and
/// interpolated elsewhere, alike on both sides.
LightSet lit(Rgb left, Rgb right) {
    EnvironmentMap image(2, 1, {left[0], left[1], left[2], right[0], right[1], right[2]});
    return LightSet({Environment(std::move(image), Rgb(1.0f), Affine3d{}, true)});
}

TEST(EvenLight, OfTheSameRadianceEverywhereHasItAsItsMean) {
    const LightSet lights({Environment(Rgb{1, 2, 3}, true)});
    EXPECT_TRUE(isEven(lights, 0));
    EXPECT_EQ(meanRadiance(lights, 0), (Rgb{1, 2, 3}));
}

TEST(EvenLight, OfTwoHalvesHasTheMeanOfBoth) {
    const LightSet lights = lit({1, 2, 3}, {3, 2, 1});
    EXPECT_TRUE(isEven(lights, 0));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(meanRadiance(lights, 0)[c], 2, 0.01);
}

TEST(EvenLight, IsNoDiscAndNoLampAndNoSharpSun) {
    const LightSet lights({Sun({0, -1, 0}, Rgb(3.0f), 0.5, false),
                           Sun({0, -1, 0}, Rgb(3.0f), 0, false),
                           PointLight{{3, 0, 0}, Rgb(10.0f)}});
    for (int light = 0; light < 3; ++light) EXPECT_FALSE(isEven(lights, light)) << light;
}

/// Of an image that shines from a share of the sphere alone, the mean of points in proportion to
/// the radiance is one over this share of the mean over the sphere.
TEST(EvenLight, IsNoImageThatShinesFromATenthOfTheSky) {
    std::vector<float> pixels(20 * 3);
    pixels[0] = pixels[1] = pixels[2] = 1;
    const LightSet lights(
        {Environment(EnvironmentMap(20, 1, pixels), Rgb(1.0f), Affine3d{}, true)});
    EXPECT_FALSE(isEven(lights, 0));
}

}  // namespace
}  // namespace woodcock::test
