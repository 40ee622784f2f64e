// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/graded_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/light/environment_map.h"

namespace woodcock::test {

using namespace light;

namespace {

Rgb seen(const EnvironmentMap& map, double elevation, double azimuth) {
    const double e = elevation * pi / 180, a = azimuth * pi / 180;
    return map.radiance({std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)});
}

TEST(GradedImage, FadesFromTheHorizonUpAndDown) {
    const Rgb below(0.1f, 0.2f, 0.3f), horizon(1, 2, 3), above(4, 0, 1);
    const EnvironmentMap map(gradedImageWidth, gradedImageHeight,
                             gradedImage(below, horizon, above));
    for (const double azimuth : {0.0, 77.0, 200.0})
        for (const double elevation : {-85.0, -30.0, -12.0, -3.0, 3.0, 5.0, 12.0, 40.0, 85.0}) {
            // Half of the way is gone at 12 degrees.
            const double share = std::exp2(-std::pow(elevation / 12, 2));
            const Rgb end = elevation > 0 ? above : below;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen(map, elevation, azimuth)[c],
                            double{end[c]} + (double{horizon[c]} - double{end[c]}) * share, 4e-3)
                    << elevation;
        }
}

}  // namespace
}  // namespace woodcock::test
