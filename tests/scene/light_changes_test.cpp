// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/overrides.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace scene;

namespace {

using Overrides = std::vector<std::string>;

const std::string volume = "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 1\n";

SceneDescription completed(const std::string& text, const Overrides& overrides = {}) {
    SceneDescription scene = parseSceneText(text, "scene.toml", ".", overrides);
    completeScene(scene, loadScene(scene));
    return scene;
}

const SunDescription& sunOf(const SceneDescription& scene) {
    return std::get<SunDescription>(scene.lights.at(0).light);
}

void expectTowards(const SunDescription& sun, Vec3d towards) {
    EXPECT_NEAR(length(normalize(sun.direction) + towards), 0, 1e-12);
}

TEST(LightChanges, MoveTheChosenSun) {
    const SceneDescription plain = completed(volume);
    ASSERT_TRUE(sunOf(plain).place);
    EXPECT_EQ(sunOf(plain).place->elevation, 40);
    const SceneDescription moved = completed(volume, {"light[0].azimuth=90"});
    EXPECT_EQ(sunOf(moved).place, (SunPlace{40, 90, UpAxis::Y}));
    // 40 degrees high towards +x.
    expectTowards(sunOf(moved), {std::cos(40 * pi / 180), std::sin(40 * pi / 180), 0});
    EXPECT_EQ(sunOf(moved).irradiance, sunOf(plain).irradiance);
    EXPECT_EQ(moved.lights.at(1), plain.lights.at(1));
}

TEST(LightChanges, OfAnyKeyOfEitherLight) {
    const SceneDescription scene =
        completed(volume, {"light[0].irradiance=[1,2,3]", "light[1].visible=false",
                           "light[1].radiance=0.5", "light[0].elevation=90"});
    EXPECT_EQ(sunOf(scene).irradiance, Rgb(1, 2, 3));
    expectTowards(sunOf(scene), {0, 1, 0});
    const auto& sky = std::get<EnvironmentDescription>(scene.lights.at(1).light);
    EXPECT_FALSE(sky.visible);
    EXPECT_EQ(sky.radiance, Rgb(0.5f));
}

TEST(LightChanges, ADirectionReplacesElevationAndAzimuth) {
    const SceneDescription chosen = completed(volume, {"light[0].direction=[0,-1,0]"});
    EXPECT_FALSE(sunOf(chosen).place);
    expectTowards(sunOf(chosen), {0, 1, 0});
    const std::string sun = volume + "[[light]]\ntype = \"sun\"\nelevation = 10\nup = \"z\"\n";
    expectTowards(sunOf(completed(sun, {"light[0].direction=[1,0,0]"})), {-1, 0, 0});
}

TEST(LightChanges, ElevationAndAzimuthTogetherReplaceADirection) {
    const std::string sun = volume + "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0]\n";
    expectTowards(sunOf(completed(sun, {"light[0].elevation=0", "light[0].azimuth=90"})),
                  {1, 0, 0});
    expectError(ErrorKind::Input, "light[0].azimuth cannot be used together with direction",
                [&] { completed(sun, {"light[0].azimuth=90"}); });
}

TEST(LightChanges, WorkOnTheSceneThatWasSaved) {
    const SceneDescription chosen = completed(volume);
    const std::string saved = writeScene(chosen);
    EXPECT_NE(saved.find("elevation = 40"), std::string::npos) << saved;
    EXPECT_EQ(saved.find("direction"), std::string::npos) << saved;
    const SceneDescription moved = completed(saved, {"light[0].azimuth=200"});
    EXPECT_EQ(sunOf(moved), sunOf(completed(volume, {"light[0].azimuth=200"})));
    EXPECT_EQ(sceneDigest(completed(saved)), sceneDigest(chosen));
}

TEST(LightChanges, MistakesAreFoundBeforeAnythingIsLoaded) {
    const auto mistake = [&](const Overrides& overrides, const std::string& more = "") {
        return messageOf(ErrorKind::Input, [&] {
            parseSceneText("[[volume]]\nfile = \"none.vdb\"\n" + more, "scene.toml", ".",
                           overrides);
        });
    };
    EXPECT_NE(mistake({"light[0].azimut=2"})
                  .find("--set light[0].azimut=2: unknown key 'azimut' in a [[light]] of type sun; "
                        "did you mean 'azimuth'?"),
              std::string::npos);
    EXPECT_NE(mistake({"light[0].elevation=100"}).find("--set light[0].elevation=100: "),
              std::string::npos);
    EXPECT_EQ(mistake({"light[3].azimuth=1"}),
              "--set light[3].azimuth=1: the scene has 3 lights, light[0] to light[2]");
    EXPECT_NE(mistake({"light[0].azimuth=1"},
                      "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\n"
                      "[[surface]]\nmaterial = \"lamp\"\nsphere = {}\n")
                  .find("--set light[0].azimuth=1: the scene has no [[light]], and none is chosen"),
              std::string::npos);
}

TEST(LightChanges, AreForeseen) {
    const auto scene = parseSceneText(volume, "s", ".", {"light[1].visible=false"});
    const auto lights = foreseenLights(scene);
    ASSERT_EQ(lights.size(), 3u);
    EXPECT_FALSE(std::get<EnvironmentDescription>(lights[1].light).visible);
    EXPECT_TRUE(scene.lights.empty());
}

}  // namespace
}  // namespace woodcock::test
