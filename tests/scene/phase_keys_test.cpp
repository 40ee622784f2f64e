// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/scene/built_scene.h"
#include "tests/support/expect_error.h"
#include "tests/support/scene_mistake.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/render/needs.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"

namespace woodcock::test {

using namespace scene;

namespace {

const std::string box = "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_s = 1\n";

SceneDescription parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parseSceneText(text, "scene.toml", ".", overrides);
}
std::string phased(const std::string& phase) { return box + "phase = " + phase + "\n"; }

render::Scene built(const std::string& text, const std::filesystem::path& directory = ".") {
    SceneDescription scene = parseSceneText(text, "scene.toml", directory);
    LoadedScene loaded = loadScene(scene);
    completeScene(scene, loaded);
    return buildScene(scene, std::move(loaded));
}
medium::PhaseFunction phaseOf(const std::string& phase) {
    return built(phased(phase)).medium.parts.at(0).phase();
}

TEST(PhaseKeys, MakeEachKind) {
    EXPECT_EQ(phaseOf("{ type = \"isotropic\" }").value(0.7), 1 / (4 * pi));
    EXPECT_EQ(phaseOf("{ type = \"henyey_greenstein\", g = 0.5 }").value(0.7),
              medium::HenyeyGreenstein(0.5).value(0.7));
    EXPECT_EQ(phaseOf("{ type = \"two_lobe\", g = 0.5, g2 = -0.25, mix = 0.125 }").value(0.7),
              medium::TwoLobes(0.5, -0.25, 0.125).value(0.7));
    EXPECT_EQ(phaseOf("{ type = \"rayleigh\" }").value(0.7), medium::Rayleigh().value(0.7));
    EXPECT_EQ(phaseOf("{ type = \"draine\", g = 0.5, alpha = 3 }").value(0.7),
              medium::Draine(0.5, 3).value(0.7));
    EXPECT_EQ(phaseOf("{ type = \"mie\" }").value(0.7), medium::MieDroplets(20).value(0.7));
    EXPECT_EQ(phaseOf("{ type = \"mie\", diameter = 7 }").value(0.7),
              medium::MieDroplets(7).value(0.7));
    EXPECT_EQ(phaseOf("{ type = \"fournier_forand\", ior = 1.1, backscatter = 0.02 }").value(0.7),
              medium::FournierForand(1.1, 0.02).value(0.7));
}

TEST(PhaseKeys, OfATableAreReadBesideTheScene) {
    const TempDir dir;
    writeText(dir / "even.txt", "-1 1 2 3\n1 1 2 3\n");
    const std::string table = "{ type = \"table\", file = \"even.txt\", normalise = true }";
    const render::Scene scene = built(phased(table), dir.path());
    EXPECT_TRUE(scene.medium.parts.at(0).phase().chromatic());
    EXPECT_TRUE(render::findNeeds(scene).chromatic);
    EXPECT_NEAR(scene.medium.parts.at(0).phase().values(0.3)[2], 1 / (4 * pi), 1e-7);
    const render::Scene held = built(
        "[[material]]\nname = \"water\"\ntype = \"dielectric\"\nior = 1.33\n"
        "[[surface]]\nsphere = {}\nmaterial = \"water\"\nmedium = { sigma_s = 1, phase = " +
            table + " }\n",
        dir.path());
    EXPECT_TRUE(held.interiorMedia.at(0).parts.at(0).phase().chromatic());
    expectError(ErrorKind::Input, "scene.toml:4:34: ", [&] {
        built(phased("{ type = \"table\", file = \"even.txt\" }"), dir.path());
    });
    expectError(ErrorKind::Input, "integral over the sphere is 12.5664",
                [&] { built(phased("{ type = \"table\", file = \"even.txt\" }"), dir.path()); });
    expectError(ErrorKind::Input, "cannot read the phase function's table",
                [&] { built(phased("{ type = \"table\", file = \"none.txt\" }"), dir.path()); });
}

/// Of absorption alone, nobody sees a phase function.
TEST(PhaseKeys, AChromaticOneThatScattersNothingNeedsNoColours) {
    const TempDir dir;
    writeText(dir / "even.txt", "-1 1 2 3\n1 1 2 3\n");
    std::string text = phased("{ type = \"table\", file = \"even.txt\", normalise = true }");
    text.replace(text.find("sigma_s = 1"), 11, "sigma_a = 1");
    EXPECT_FALSE(render::findNeeds(built(text, dir.path())).chromatic);
}

TEST(PhaseKeys, AreRefusedWithPlaceAndReason) {
    const auto mistake = [](const std::string& phase) { return mistakeIn(phased(phase)); };
    EXPECT_EQ(mistake("{ type = \"mie\", diameter = 60 }"),
              "scene.toml:4:36: volume[0].phase.diameter is 60; it must lie between 1.5 and 50");
    EXPECT_EQ(mistake("{ type = \"draine\", g = 1, alpha = 1 }"),
              "scene.toml:4:32: volume[0].phase.g is 1; it must lie strictly between -1 and 1");
    EXPECT_EQ(mistake("{ type = \"draine\", g = 0.5, alpha = -1 }"),
              "scene.toml:4:45: volume[0].phase.alpha is -1; it must not be negative");
    EXPECT_EQ(
        mistake("{ type = \"fournier_forand\", backscatter = 0.5 }"),
        "scene.toml:4:51: volume[0].phase.backscatter is 0.5; it must lie strictly between 0 and "
        "0.5");
    EXPECT_EQ(mistake("{ type = \"fournier_forand\", ior = 1 }"),
              "scene.toml:4:43: volume[0].phase.ior is 1; it must lie strictly between 1 and 2");
    EXPECT_EQ(mistake("{ type = \"two_lobe\", g = 0.5, g2 = 0, mix = 1.5 }"),
              "scene.toml:4:53: volume[0].phase.mix is 1.5; it must lie between 0 and 1");
    EXPECT_NE(mistake("{ type = \"two_lobe\", g = 0.5 }").find("g2"), std::string::npos);
    EXPECT_NE(mistake("{ type = \"miee\" }").find("phase function type"), std::string::npos);
    EXPECT_NE(mistake("{ type = \"rayleigh\", g = 0.5 }").find("type rayleigh"), std::string::npos);
    EXPECT_NE(mistake("0.5").find("volume[0].phase"), std::string::npos);
    EXPECT_NE(mistake("{ type = \"table\" }").find("file"), std::string::npos);
    EXPECT_NE(mistakeIn(phased("{ type = \"rayleigh\" }") + "g = 0.5\n")
                  .find("both say how the volume scatters"),
              std::string::npos);
}

TEST(PhaseKeys, AreWrittenAndReadBack) {
    for (const char* phase :
         {"{ type = \"isotropic\" }", "{ type = \"henyey_greenstein\", g = 0.5 }",
          "{ type = \"two_lobe\", g = 0.5, g2 = -0.25, mix = 0.125 }", "{ type = \"rayleigh\" }",
          "{ type = \"draine\", g = 0.5, alpha = 3.0 }", "{ type = \"mie\" }",
          "{ type = \"fournier_forand\", ior = 1.1 }",
          "{ type = \"table\", file = \"b.txt\", normalise = true }"}) {
        SceneDescription scene = parse(phased(phase)), back = parse(writeScene(scene));
        scene.places.clear(), back.places.clear();
        EXPECT_EQ(back, scene) << writeScene(scene);
    }
}

TEST(PhaseKeys, TakeThePlaceOfGWhereTheyAreSetAndTheOtherWayRound) {
    const std::string mie = "volume[0].phase={ type = \"mie\" }";
    EXPECT_TRUE(parse(box + "g = 0.6\n", {mie}).volumes[0].phase.has_value());
    EXPECT_TRUE(parse(box + "g = 0.6\n", {"volume[0].phase.type=mie"}).volumes[0].phase);
    const auto back = parse(phased("{ type = \"rayleigh\" }"), {"volume[0].g=0.5"}).volumes[0];
    EXPECT_EQ(back.g, 0.5f);
    EXPECT_FALSE(back.phase);
    EXPECT_EQ(
        std::get<MiePhase>(
            *parse(phased("{ type = \"mie\" }"), {"volume[0].phase.diameter=5"}).volumes[0].phase)
            .diameter,
        5);
}

}  // namespace
}  // namespace woodcock::test
