// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/view_depth.h"

#include <gtest/gtest.h>

#include "woodcock/proof/support/render_scene.h"

namespace woodcock::test {

using namespace render;
using namespace proof;

namespace {

/// Of a box from -1 to 1 with an even extinction, seen from `eye` towards -z, at 40 x 40 pixels.
std::optional<ClosedView> viewOf(const std::string& scale, const std::string& eye,
                                 const std::string& more = "") {
    const Scene scene = proof::sceneFrom(
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nscale = " + scale +
        "\n[[light]]\ntype = \"environment\"\n[camera]\ntype = \"orthographic\"\nheight = 1\n"
        "eye = " +
        eye + "\nlook_at = [0, 0, -9]\n[render]\nresolution = [40, 40]\n" + more);
    return findClosedView(scene, 40, 40);
}

TEST(ViewDepth, IsThatOfTheMediumBeforeTheCamera) {
    const auto view = viewOf("50", "[0, 0, 0.5]");
    ASSERT_TRUE(view);
    EXPECT_EQ(view->part, 0u);
    EXPECT_NEAR(view->depth, 75, 1e-4);           // 1.5 units
    EXPECT_NEAR(view->meanFreePath, 0.02, 1e-9);  // 1 / 50
}

TEST(ViewDepth, CountsEveryMediumAndNamesTheDensest) {
    const auto view = viewOf("50", "[0, 0, 0.5]",
                             "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
                             "scale = 100\n");
    ASSERT_TRUE(view);
    EXPECT_EQ(view->part, 1u);
    EXPECT_NEAR(view->depth, 225, 1e-3);
}

TEST(ViewDepth, OfCamerasThatSeeSomethingElseIsNotSaid) {
    EXPECT_FALSE(viewOf("50", "[0, 0, 5]"));     // outside
    EXPECT_FALSE(viewOf("1", "[0, 0, 0.5]"));    // thin: 1.5
    EXPECT_FALSE(viewOf("6", "[0, 0, 0.5]"));    // 9, below 10
    EXPECT_TRUE(viewOf("7", "[0, 0, 0.5]"));     // 10.5
    EXPECT_FALSE(viewOf("50", "[0, 0, -0.9]"));  // 5 deep: looks out of it
}

TEST(ViewDepth, EndsAtSurfaces) {
    const std::string wall =
        "[[surface]]\nplane = {}\ntransform = { rotate = [90, 0, 0], translate = [0, 0, 0.4] }\n";
    EXPECT_FALSE(viewOf("50", "[0, 0, 0.5]", wall));  // 5 deep up to the wall
    EXPECT_TRUE(viewOf("500", "[0, 0, 0.5]", wall));  // 50
}

TEST(ViewDepth, InsideOfASurfaceTheMediumOutsideDoesNotCount) {
    EXPECT_FALSE(viewOf("50", "[0, 0, 0.5]",
                        "[[material]]\nname = \"air\"\ntype = \"interface\"\n"
                        "[[surface]]\nmaterial = \"air\"\n"
                        "sphere = { centre = [0, 0, 0.5], radius = 0.3 }\n"));
}

}  // namespace
}  // namespace woodcock::test
