// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/media_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace render;

namespace {

/// Of a cube 2 wide, whose diagonal is 3.46.
bool pays(double sigma, double g) {
    const Scene scene =
        proof::sceneFrom(fmt::format("[[volume]]\nbox = {{ min = [-1, -1, -1], max = [1, 1, 1] }}\n"
                                     "sigma_s = {}\ng = {}\n"
                                     "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n",
                                     sigma, g));
    return thickAndPeaked(MediumSummary(scene.medium));
}

/// The mean density of a sampled direction, over the isotropic one, is (1 + g^2) / (1 - g^2)^2.
TEST(MediaTable, SeveralEventsAreForThickMediaWithAPeak) {
    EXPECT_TRUE(pays(10, 0.85));   // 34.6 thick, 22 peaked
    EXPECT_FALSE(pays(8, 0.85));   // 27.7 thick
    EXPECT_TRUE(pays(10, 0.75));   // 8.2 peaked
    EXPECT_FALSE(pays(10, 0.74));  // 7.6 peaked
    EXPECT_FALSE(pays(100, 0));
    EXPECT_TRUE(pays(10, -0.85));
    EXPECT_FALSE(thickAndPeaked(MediumSummary(medium::Medium())));
}

}  // namespace
}  // namespace woodcock::test
