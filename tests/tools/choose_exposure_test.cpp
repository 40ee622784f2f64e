// SPDX-License-Identifier: Apache-2.0
#include "tools/render/choose_exposure.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tools/render/trial.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace scene;
using namespace tool;

namespace {

TEST(BrightRadiance, IsAQuantileOfWhatIsSeen) {
    // 100 blocks of radiance 1 to 100 that cover all, beside a background that is brighter.
    image::Film film(60, 30, {0, 0, 60, 30},
                     {.surfaces = false, .features = false, .background = true});
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 60; ++x) {
            const int block = y / 3 * 10 + x / 3 + 1;
            if (x < 30)
                film.add(x, y, {.radiance = Rgb(static_cast<float>(block)), .alpha = 1});
            else
                film.add(x, y, {.radiance = Rgb(1e4f), .background = Rgb(1e4f)});
        }
    EXPECT_EQ(brightRadiance(film), 100 * brightShare);
}

TEST(BrightRadiance, IsZeroOfNothing) {
    EXPECT_EQ(brightRadiance(image::Film(9, 9, {0, 0, 9, 9})), 0);
}

TEST(ChooseExposure, BringsTheBrightPartsNearWhite) {
    const image::DisplayTransform display = image::ColorConfig().displayTransform({});
    const auto exposure = [&](double radiance) {
        SceneDescription scene = parseSceneText(
            "[[surface]]\nsphere = {}\nmaterial = \"lamp\"\n[[material]]\nname = \"lamp\"\n"
            "type = \"emissive\"\nradiance = " +
                std::to_string(radiance) + "\n",
            "scene.toml", ".");
        const LoadedScene loaded = loadScene(scene);
        completeScene(scene, loaded);
        return chooseExposure(
            renderTrial(buildScene(scene, loaded), scene::renderSettings(scene.render)).film,
            display);
    };
    for (const double radiance : {0.01, 1.0, 30.0}) {
        const auto light = static_cast<float>(radiance * std::exp2(exposure(radiance)));
        std::array<float, 4> pixel{light, light, light, 1};
        display.apply(pixel);
        EXPECT_NEAR(pixel[1], brightDisplayValue, 0.01) << radiance;
    }
    EXPECT_NEAR(exposure(1) - exposure(4), 2, 0.051);
}

}  // namespace
}  // namespace woodcock::test
