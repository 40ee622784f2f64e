// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/quality.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/expect_error.h"
#include "tests/support/paths.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace grid;
using namespace scene;

namespace {

SceneDescription parse(const std::string& render, const std::vector<std::string>& overrides = {},
                       const std::string& volume = "") {
    return parseSceneText("[[volume]]\nfile = \"a.vdb\"\n" + volume + "\n[render]\n" + render,
                          "q.toml", "", overrides);
}

TEST(Quality, BringsItsChoices) {
    for (const std::string& name : qualityNames) {
        std::string written;
        const auto quality = static_cast<Quality>(
            std::find(qualityNames.begin(), qualityNames.end(), name) - qualityNames.begin());
        for (const RenderChoice& choice : qualityChoices(quality))
            written += choice.key + " = " + choice.value + "\n";
        EXPECT_EQ(parse("quality = \"" + name + "\"").render, parse(written).render) << name;
        EXPECT_EQ(parse("", {"render.quality=" + name}).render, parse(written).render) << name;
    }
    expectError(ErrorKind::Input, "unknown quality 'finall'; known: draft",
                [] { parse("quality = \"finall\""); });
    expectError(ErrorKind::Input, "q.toml:5:11", [] { parse("quality = 3"); });
}

TEST(Quality, FinalAndReferenceAreUnbiased) {
    EXPECT_FALSE(biasedChoices(parse("quality = \"draft\"")).empty());
    EXPECT_FALSE(biasedChoices(parse("quality = \"preview\"")).empty());
    EXPECT_TRUE(biasedChoices(parse("quality = \"final\"")).empty());
    EXPECT_TRUE(biasedChoices(parse("quality = \"reference\"")).empty());
    EXPECT_EQ(parse("quality = \"reference\"").render.storage, Storage::Float);
    EXPECT_EQ(parse("quality = \"reference\"").render.adaptive, false);
}

TEST(Quality, KeysBesideItWin) {
    const RenderDescription draft =
        parse("quality = \"draft\"\nstorage = \"float\"\nclamp = 3").render;
    EXPECT_EQ(draft.storage, Storage::Float);
    EXPECT_EQ(draft.approximations.clamp, 3);
    EXPECT_TRUE(draft.approximations.similarityAfter);
    const RenderDescription preview = parse("quality = \"preview\"\noctaves = 5").render;
    EXPECT_EQ(preview.approximations.octaves, 5) << "which displaces similarity_after";
    EXPECT_FALSE(preview.approximations.similarityAfter);
}

TEST(Quality, PreviewsAreDenoisedWherePossible) {
    EXPECT_EQ(parse("quality = \"preview\"").render.denoise, Denoise::IfInstalled);
    EXPECT_EQ(parse("quality = \"preview\"\ndenoise = false").render.denoise, Denoise::Never);
    EXPECT_EQ(parse("quality = \"final\"\ndenoise = true").render.denoise, Denoise::Always);
    EXPECT_EQ(parse("denoise = true", {"render.quality=final"}).render.denoise, Denoise::Never);
    EXPECT_EQ(biasedChoices(parse("denoise = true")), std::vector<std::string>{"render.denoise"});
    expectError(ErrorKind::Input, "is 'auto'; expected true, false or \"if_installed\"",
                [] { parse("denoise = \"auto\""); });
}

TEST(Quality, OfTheCommandLineReplacesWhatTheSceneSays) {
    const std::string written = "clamp = 3\nmarch_step = 2\nmarch_estimate = \"exponential\"";
    const std::string half = "storage = \"half\"";
    EXPECT_FALSE(biasedChoices(parse(written, {}, half)).empty());
    EXPECT_TRUE(biasedChoices(parse(written, {"render.quality=final"}, half)).empty());
    const SceneDescription more =
        parse(written, {"render.quality=final", "render.clamp=5", "render.spp=3"});
    EXPECT_EQ(biasedChoices(more), std::vector<std::string>{"render.clamp"});
    EXPECT_EQ(parse("max_scatterings = 2", {"render.quality=final"}).render.maxScatterings, 2)
        << "that is what the scene is";
}

TEST(Quality, EveryBiasedChoiceIsNamed) {
    const std::string all =
        "max_scatterings = 2\nmax_bounces = 2\nstorage = \"half\"\ntransparent_shadows = true\n"
        "march_step = 1\nsimilarity_after = 1\nclamp = 1\nlookup = \"nearest\"\n"
        "level_of_detail = 1";
    EXPECT_EQ(biasedChoices(parse(all)).size(), 9u);
    EXPECT_EQ(biasedChoices(parse("octaves = 1", {}, "storage = \"half\"")),
              (std::vector<std::string>{"render.octaves", "volume[0].storage"}));
    EXPECT_TRUE(biasedChoices(parse("adaptive = true\nmajorant_scale = 2")).empty());
}

/// "| `draft` | `clamp = 3`, `lookup = "nearest"` | ...": the cells of the line of a quality.
std::string documentedChoices(const std::string& quality) {
    std::istringstream text(readText(sourceDir() / "data/scenes/README.md"));
    const std::string start = "| `\"" + quality + "\"` | ";
    for (std::string line; std::getline(text, line);)
        if (line.starts_with(start))
            return line.substr(start.size(), line.find(" | ", start.size()) - start.size());
    return "no line of " + quality;
}

TEST(Quality, TheReferenceSaysWhatEachIs) {
    for (std::size_t q = 0; q < qualityNames.size(); ++q) {
        std::string expected;
        for (const RenderChoice& choice : qualityChoices(static_cast<Quality>(q)))
            expected += (expected.empty() ? "`" : ", `") + choice.key + " = " + choice.value + "`";
        EXPECT_EQ(documentedChoices(qualityNames[q]), expected);
    }
}

}  // namespace
}  // namespace woodcock::test
