// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/candidates.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace scene;
using namespace trade;

namespace {

const std::string fog = R"(
[[volume]]
box = { min = [0, 0, 0], max = [1, 1, 1] }
sigma_s = 1
g = 0.5
[[light]]
type = "environment"
[camera]
eye = [0, 0, 5]
look_at = [0, 0, 0]
[render]
resolution = [16, 8]
)";

ParseScene parserOf(const std::string& text) {
    return [text](const std::vector<std::string>& overrides) {
        return parseSceneText(text, "fog.toml", "", overrides);
    };
}

class Candidates : public testing::Test {
protected:
    std::vector<Candidate> read(const std::string& text) const {
        writeText(dir / "c.toml", text);
        return readCandidates(dir / "c.toml");
    }
    void expectMistake(const std::string& text, const std::string& message) const {
        expectError(ErrorKind::Input, message, [&] { read(text); });
    }
    const TempDir dir;
};

TEST_F(Candidates, AreRead) {
    const std::vector<Candidate> list = read(R"(
[[candidate]]
name = "as it is"
[[candidate]]
name = "fast"
quality = "draft"
set = ["render.clamp=10", "volume[0].storage=half"])");
    ASSERT_EQ(list.size(), 2u);
    EXPECT_TRUE(list[0].overrides().empty());
    EXPECT_EQ(list[1].overrides(),
              (std::vector<std::string>{"render.quality=draft", "render.clamp=10",
                                        "volume[0].storage=half"}));
}

TEST_F(Candidates, MistakesAreNamedWithTheirPlace) {
    expectMistake("", "there is no [[candidate]]");
    expectMistake("[candidate]\nname = \"a\"", "write [[candidate]]");
    expectMistake("[[candidate]]\nset = []", "name");
    expectMistake("[[candidate]]\nname = \"a\"\nsets = []", "c.toml:3");
    expectMistake("[[candidate]]\nname = \"a\"\nquality = \"finl\"",
                  "c.toml:3:11: unknown quality 'finl'");
    expectMistake("[[candidate]]\nname = \"a\"\n[[candidate]]\nname = \"a\"", "is called 'a'");
    const auto set = [](const std::string& text) {
        return "[[candidate]]\nname = \"a\"\nset = [" + text + "]";
    };
    expectMistake(set("\"render.clamp\""), "expected KEY=VALUE");
    expectMistake(set("\"render.clamp=1\", \"render.clamp = 2\""), "sets 'render.clamp' again");
    expectMistake(set("\"render.quality=draft\""), "write quality = ");
    expectMistake(set("\"render.klamp=1\""), "did you mean 'render.clamp'?");
    for (const std::string key :
         {"render.resolution=[8, 8]", "camera.fov=20", "light[0].radiance=2",
          "volume[0].file=other.vdb", "volume[0].scale=2", "render.spp=3"})
        expectMistake(set("\"" + key + "\""), "candidates must render the same picture");
}

TEST_F(Candidates, ThatContradictThemselvesOrEachOtherAreRefused) {
    const ParseScene parse = parserOf(fog);
    const SceneDescription scene = parse({});
    const auto resolve = [&](const std::vector<Candidate>& list, bool strict) {
        return resolveCandidates(list, scene, parse, strict);
    };
    const std::vector<Candidate> itself{
        {"both", "", {"render.octaves=4", "render.similarity_after=2"}}};
    expectError(ErrorKind::Input, "candidate 'both'", [&] { resolve(itself, true); });
    EXPECT_TRUE(resolve(itself, false).empty());
    const std::vector<Candidate> twins{{"a", "", {"render.clamp=10"}},
                                       {"b", "", {"render.clamp=1e1"}}};
    expectError(ErrorKind::Input, "'a' and 'b'", [&] { resolve(twins, true); });
    EXPECT_EQ(resolve(twins, false).size(), 1u);
    expectError(ErrorKind::Input, "candidate 'far'", [&] {
        resolve({{"far", "", {"volume[1].storage=half"}}}, true);
    });
}

TEST_F(Candidates, BuiltInOnesFitTheScene) {
    const auto names = [](const SceneFacts& facts, Extent extent) {
        std::string all;
        for (const Candidate& c : builtInCandidates(facts, extent)) all += c.name + "; ";
        return all;
    };
    SceneFacts facts;
    facts.scattering = true;
    facts.mostScatterings = 3;
    std::string all = names(facts, Extent::All);
    for (const char* missing : {"march", "similarity", "storage", "level", "nearest", "clamp",
                                "shadows", "4 scatterings"})
        EXPECT_EQ(all.find(missing), std::string::npos) << missing << " in " << all;
    EXPECT_NE(all.find("1 scattering;"), std::string::npos) << all;
    facts = {true, true, 100, 0.5, true, false, 0.21};
    all = names(facts, Extent::All);
    for (const char* there : {"march step 2", "similarity after 4", "storage half", "octaves",
                              "level of detail 1", "nearest", "clamp 2;", "transparent shadows",
                              "16 scatterings", "draft", "preview", "final", "reference"})
        EXPECT_NE(all.find(there), std::string::npos) << there << " not in " << all;
    EXPECT_EQ(all.find("denoised"), std::string::npos) << "there is no denoiser";
    facts.denoiser = true;
    for (const Extent extent : {Extent::All, Extent::Few})
        EXPECT_NE(names(facts, extent).find("; denoised;"), std::string::npos);
    facts.cameraInside = true;
    EXPECT_EQ(names(facts, Extent::All).find("level"), std::string::npos);
    EXPECT_LT(names(facts, Extent::Few).size(), all.size() / 2);
}

TEST_F(Candidates, EveryBuiltInOneIsAScene) {
    const ParseScene parse = parserOf(fog);
    const SceneFacts facts{true, true, 100, 0.5, true, false, 0.21};
    const auto all = builtInCandidates(facts, Extent::All);
    for (const Candidate& c : all) EXPECT_NO_THROW(parse(c.overrides())) << c.name;
    EXPECT_EQ(Candidate({"a", "", {"render.march_step=1"}}).papers(), "Peters 2025");
    EXPECT_EQ(Candidate({"a", "", {"render.clamp=1"}}).papers(), "");
}

}  // namespace
}  // namespace woodcock::test
