// SPDX-License-Identifier: Apache-2.0
#include "woodcock/surface/texture.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/expect_error.h"

namespace woodcock::test {

using namespace surface;

namespace {

/// Rows from the top: 1 2 3 4 / 5 6 7 8.
TextureImage numbers() {
    std::vector<float> rgb;
    for (int i = 1; i <= 8; ++i) rgb.insert(rgb.end(), {static_cast<float>(i), 0, 0.5f});
    return {4, 2, rgb};
}

TEST(TextureImage, HasItsTexelsAtTheirCentresAndVUpwards) {
    const TextureImage image = numbers();
    for (int x = 0; x < 4; ++x) {
        EXPECT_NEAR(image.at((x + 0.5) / 4, 0.75)[0], x + 1, 1e-6);
        EXPECT_NEAR(image.at((x + 0.5) / 4, 0.25)[0], x + 5, 1e-6);
    }
    EXPECT_EQ(image.at(0.3, 0.3)[1], 0);
    EXPECT_NEAR(image.at(0.3, 0.3)[2], 0.5, 1e-7);
}

TEST(TextureImage, IsBilinearBetweenThem) {
    const TextureImage image = numbers();
    EXPECT_NEAR(image.at(0.25, 0.75)[0], 1.5, 1e-6);
    EXPECT_NEAR(image.at(0.125, 0.5)[0], 3, 1e-6);
    EXPECT_NEAR(image.at(0.125 + 0.25 * 0.25, 0.75 - 0.5 * 0.1)[0], 1.25 + 0.4, 1e-6);
}

TEST(TextureImage, IsRepeated) {
    const TextureImage image = numbers();
    EXPECT_NEAR(image.at(0, 0.75)[0], 2.5, 1e-6);  // between 4 and 1
    EXPECT_NEAR(image.at(0.125, 1)[0], 3, 1e-6);   // between 1 and 5
    for (const double u : {0.0, 0.1, 0.5, 0.99})
        for (const double v : {0.0, 0.3, 0.9})
            for (const int turn : {-3, 1, 1000})
                EXPECT_NEAR(image.at(u + turn, v - turn)[0], image.at(u, v)[0], 1e-4);
}

TEST(TextureImage, StandsAnyCoordinates) {
    const TextureImage image = numbers();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double u : {-1e-300, -1e-17, 1e300, -1e300, infinity, -infinity,
                           std::numeric_limits<double>::quiet_NaN()})
        for (const double v : {0.4, u}) {
            const float value = image.at(u, v)[0];
            EXPECT_TRUE(value >= 1 && value <= 8) << u << " " << v << " " << value;
        }
    const TextureImage one(1, 1, {0.25f, 0.5f, 1});
    EXPECT_EQ(one.at(0.9, 0.1), Rgb(0.25f, 0.5f, 1));
}

TEST(TextureImage, KnowsItsMaximumAndMean) {
    const TextureImage image = numbers();
    EXPECT_EQ(image.maximum(), Rgb(8, 0, 0.5f));
    EXPECT_EQ(image.mean(), Rgb(4.5f, 0, 0.5f));
}

TEST(TextureImage, RefusesNumbersThatDoNotFillIt) {
    for (const std::size_t count : {0u, 5u, 7u, 9u})
        expectError(ErrorKind::Failure, "cannot have",
                    [&] { TextureImage(2, 1, std::vector<float>(count)); });
    expectError(ErrorKind::Failure, "0 x 1", [] { TextureImage(0, 1, {}); });
}

TEST(Texture, IsAColourOrAnImageTimesOne) {
    EXPECT_EQ(Texture(Rgb(0.25f)).at(3, 4), Rgb(0.25f));
    const Texture both(Rgb(0.5f, 1, 2), std::make_shared<TextureImage>(numbers()));
    EXPECT_NEAR(both.at(0.125, 0.75)[0], 0.5, 1e-6);
    EXPECT_EQ(both.maximum(), Rgb(4, 0, 1));
}

}  // namespace
}  // namespace woodcock::test
