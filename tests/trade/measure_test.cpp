// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/measure.h"

#include <gtest/gtest.h>

#include "tests/support/environment_variable.h"
#include "tests/support/paths.h"
#include "tests/tools/fog_scene.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/denoising.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace trade;

namespace {

// What the fake library makes of the film of the last stage: see tests/programs/fake_oidn.cpp.
TEST(RenderStages, OfADenoisedSubjectAreDenoisedEach) {
    const EnvironmentVariable library("WOODCOCK_OIDN", fakeOidn().string());
    scene::SceneDescription fog =
        scene::parseSceneText(std::string(fogScene()) + "denoise = true\n", "fog.toml", ".");
    const auto denoiser = scene::settleDenoising(fog);
    ASSERT_TRUE(denoiser);
    SceneStore store;
    const PictureSize size{6, 4};
    const Subject plain(store.get(fog), fog, size), denoised(store.get(fog), fog, size, denoiser);
    const auto goOn = [] { return true; };
    const auto plainStages = renderStages(plain, 3, {2, 8}, 1, goOn);
    const auto stages = renderStages(denoised, 3, {2, 8}, 1, goOn);
    ASSERT_EQ(stages->size(), 2u);
    EXPECT_EQ(plainStages->back().denoiseSeconds, 0);

    render::RenderSettings settings;
    settings.width = size.width, settings.height = size.height;
    settings.endSample = 8, settings.seed = 3, settings.layers.features = true;
    const image::Film film = render::render(*plain.scene, settings).film;
    std::size_t i = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            for (int c = 0; c < 3; ++c, ++i) {
                const float features = film.albedo(x, y)[c] / 2 + film.normal(x, y)[c] / 4;
                EXPECT_FLOAT_EQ(plainStages->back().pixels[i], film.radiance(x, y)[c]);
                EXPECT_FLOAT_EQ(stages->back().pixels[i], film.radiance(x, y)[c] + features);
            }
    EXPECT_NE(stages->front().pixels, plainStages->front().pixels);
}

}  // namespace
}  // namespace woodcock::test
