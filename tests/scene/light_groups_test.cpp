// SPDX-License-Identifier: Apache-2.0
// Light groups, from the scene file to the built scene, and every mistake.
#include "woodcock/scene/light_groups.h"

#include <gtest/gtest.h>

#include "tests/scene/built_scene.h"
#include "tests/support/scene_mistake.h"

namespace woodcock::test {

using namespace scene;

namespace {

const std::string box = "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_s = 1\n";
const std::string glow = box + "emission = 1\ngroup = \"fire\"\n";
const std::string sun = "[[light]]\ntype = \"sun\"\nelevation = 40\n";
const std::string sky = "[[light]]\ntype = \"sky\"\nelevation = 40\nsun = true\n";
const std::string lamp = "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\n";
const std::string ball = "[[surface]]\nsphere = {}\nmaterial = \"lamp\"\n";

using Names = std::vector<std::string>;

Names groupsOf(const std::string& text, const Names& overrides = {}) {
    return lightGroups(parseSceneText(text, "scene.toml", ".", overrides));
}

TEST(LightGroups, AreNamedOnceInTheOrderOfTheScene) {
    EXPECT_EQ(groupsOf(box + sun), Names{});
    EXPECT_EQ(groupsOf(sun + "group = \"key\"\n" + glow + lamp + "group = \"key\"\n" + ball + sun +
                       "group = \"fill\"\n"),
              (Names{"fire", "key", "fill"}));
    EXPECT_EQ(groupsOf("[[surface]]\nsphere = {}\nmaterial = \"g\"\n"
                       "medium = { emission = 1, group = \"lava\" }\n"
                       "[[material]]\nname = \"g\"\ntype = \"interface\"\n"),
              Names{"lava"});
    EXPECT_EQ(groupsOf(box, {"light[1].group=key"}), Names{"key"});
}

TEST(LightGroups, ReachTheLightsOfAllKinds) {
    const BuiltScene built =
        buildLit(glow + sky + "group = \"sky\"\n" + sun + lamp + "group = \"lamp\"\n" + ball);
    const light::LightSet& lights = built.scene.lights;
    // fire, lamp, sky; a sky is two lights, and emissive surfaces are the last.
    ASSERT_EQ(lights.lights().size(), 5u);
    EXPECT_EQ(lights.group(0), 3);
    EXPECT_EQ(lights.group(1), 3);
    EXPECT_EQ(lights.group(2), 0);
    EXPECT_EQ(lights.group(3), 0);
    EXPECT_EQ(lights.group(4, 0), 2);
    EXPECT_EQ(built.scene.surfaces->objects[0].lightGroup, 2);
    EXPECT_EQ(built.scene.medium.emission[0].description().group, 1);
}

TEST(LightGroups, OfAMixAreThoseOfWhatEmits) {
    const std::string paint = "[[material]]\nname = \"paint\"\ntype = \"diffuse\"\n";
    const std::string mix =
        "[[material]]\nname = \"m\"\ntype = \"mix\"\nfirst = \"paint\"\nsecond = \"lamp\"\n";
    const BuiltScene built = buildLit(box + lamp + "group = \"lamp\"\n" + paint + mix +
                                      "[[surface]]\nsphere = {}\nmaterial = \"m\"\n");
    EXPECT_EQ(built.scene.surfaces->objects[0].lightGroup, 1);
}

TEST(LightGroups, BadNamesAreRefusedWhereTheyStand) {
    EXPECT_EQ(mistakeIn(box + sun + "group = \"emission\"\n"),
              "scene.toml:7:9: light[0].group is 'emission', which is the name of a layer; take "
              "another one");
    EXPECT_EQ(
        mistakeIn(box + sun + "group = \"key light\"\n"),
        "scene.toml:7:9: light[0].group is 'key light', which holds ' '; names of layers hold "
        "letters, digits, _ and -, or compositors rename them");
    EXPECT_EQ(mistakeIn(box + "group = \"a.b\"\n").substr(0, 62),
              "scene.toml:4:9: volume[0].group is 'a.b', which holds '.'; nam");
    EXPECT_EQ(mistakeIn(box + sun + "gruop = \"key\"\n").substr(0, 17), "scene.toml:7:1: u");
    EXPECT_EQ(
        mistakeIn("[[surface]]\nsphere = {}\nmaterial = \"g\"\n"
                  "medium = { sigma_a = 1, group = \"lava\" }\n"
                  "[[material]]\nname = \"g\"\ntype = \"interface\"\n"),
        "scene.toml:4:33: surface[0].medium.group is for emission; give emission, or leave it "
        "out");
}

/// Nuke makes _ of -, so these two would be one layer there.
TEST(LightGroups, NamesThatNukeTakesForOneAreRefused) {
    EXPECT_EQ(mistakeIn(box + sun + "group = \"a-b\"\n" + sun + "group = \"a_b\"\n"),
              "scene.toml:11:9: light[1].group is 'a_b', and there is a group 'a-b': Nuke takes - "
              "for _, and makes one layer of both; rename one of them");
    EXPECT_EQ(mistakeIn(box + sun + "group = \"a-b\"\n" + sun + "group = \"a-b\"\n"), "");
}

TEST(LightGroups, TooManyAreRefused) {
    std::string lights = box;
    for (std::size_t i = 0; i <= image::mostLightGroups; ++i)
        lights += sun + fmt::format("group = \"g{}\"\n", i);
    EXPECT_EQ(mistakeIn(lights).substr(11),
              "1027:9: light[255].group is 'g255', but there are 255 light groups already, and no "
              "more can be told apart; give several lights one group");
    EXPECT_EQ(mistakeIn(box + sun + "group = \"a\"\n"), "");
}

TEST(LightGroups, AMixOfTwoIsRefused) {
    const std::string two =
        lamp + "group = \"a\"\n[[material]]\nname = \"other\"\ntype = \"emissive\"\n" +
        "[[material]]\nname = \"m\"\ntype = \"mix\"\nfirst = \"lamp\"\nsecond = \"other\"\n" + ball;
    EXPECT_EQ(
        mistakeIn(two),
        "scene.toml:8:1: material[2] mixes light of two groups, 'a' and none; a surface counts "
        "to one, so give both the same, or make two surfaces");
}

TEST(LightGroups, TheOutputNamesOnlyThoseThatAreThere) {
    EXPECT_EQ(mistakeIn(glow + "[output]\nlayers = [\"lightgroup_fire\", \"lightgroup_rest\"]\n"),
              "");
    EXPECT_EQ(mistakeIn(glow + "[output]\nlayers = [\"lightgroup_fier\"]\n"),
              "scene.toml:7:10: output.layers is wrong: the scene has no light group for the layer "
              "'lightgroup_fier'; did you mean 'lightgroup_fire'? its layers of groups: "
              "lightgroup_rest, lightgroup_fire");
}

}  // namespace
}  // namespace woodcock::test
