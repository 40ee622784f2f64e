// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/mattes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/support/decode_cryptomatte.h"
#include "tests/support/expect_error.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using image::MatteLayer;

namespace {

std::vector<MatteLayer> layersOf(const std::string& text, std::vector<std::string>* notes = nullptr,
                                 const std::string& kind = "object") {
    return scene::matteLayers(scene::parseSceneText(text, "scene.toml", "."), {kind}, notes);
}

TEST(MatteNames, LeftOpenAreChosenAndTold) {
    std::vector<std::string> notes;
    const auto layers = layersOf(
        "[[volume]]\nfile = \"shots/fire_0045.vdb\"\n[[volume]]\nfile = \"fire.0046.vdb\"\n"
        "[[volume]]\nfile = \"0046.vdb\"\n[[volume]]\nfile = \"cloud2.vdb\"\n"
        "[[volume]]\nname = \"sphere\"\nfile = \"a.vdb\"\n"
        "[[surface]]\nsphere = {}\n[[surface]]\nname = \"floor\"\nplane = {}\n",
        &notes);
    EXPECT_EQ(layers[0].names, (std::vector<std::string>{"sphere", "floor", "fire", "fire_2",
                                                         "volume", "cloud2", "sphere_2"}));
    EXPECT_EQ(layers[0].nameOf, (std::vector<std::uint32_t>{2, 3, 4, 5, 0, 6, 1}));
    EXPECT_EQ(notes, (std::vector<std::string>{
                         "volume[0].name = \"fire\"", "volume[1].name = \"fire_2\"",
                         "volume[2].name = \"volume\"", "volume[3].name = \"cloud2\"",
                         "surface[0].name = \"sphere_2\""}));
}

TEST(MatteNames, OfSequencesLeaveThePatternOut) {
    for (const char* file : {"shots/fire_####.vdb", "fire.%04d.vdb", "fire$F4.vdb",
                             "shots.$F/fire_$F.vdb", "fire-<frame04>.vdb"})
        EXPECT_EQ(layersOf(fmt::format("[[volume]]\nfile = \"{}\"\n", file))[0].names,
                  std::vector<std::string>{"fire"})
            << file;
}

TEST(MatteNames, TakenAreRefused) {
    const std::string twice =
        "[[volume]]\nname = \"a\"\nfile = \"b.vdb\"\n\n[[volume]]\nname = \"a\"\n"
        "file = \"c.vdb\"\n";
    expectError(
        ErrorKind::Input,
        "scene.toml:6:8: volume[1].name is 'a', which is the name of volume[0].name already",
        [&] { layersOf(twice); });
    expectError(ErrorKind::Input,
                "volume[0].name is 'a', which is the name of material[0].name already", [] {
                    layersOf(
                        "[[volume]]\nname = \"a\"\nfile = \"b.vdb\"\n"
                        "[[surface]]\nsphere = {}\nmaterial = \"a\"\n"
                        "[[material]]\nname = \"a\"\ntype = \"diffuse\"\n",
                        nullptr, "material");
                });
    expectError(ErrorKind::Usage, "unknown matte 'objekt'; did you mean 'object'?",
                [] { layersOf("[[volume]]\nfile = \"b.vdb\"\n", nullptr, "objekt"); });
}

TEST(MatteNames, OfOneIdAreRefused) {
    std::map<std::uint32_t, std::string> names;
    std::string first, second;
    for (int i = 0; second.empty() && i < 1'000'000; ++i) {
        const std::string name = fmt::format("n{}", i);
        const auto [other, isNew] = names.emplace(murmur3(name), name);
        if (!isNew) first = other->second, second = name;
    }
    ASSERT_FALSE(second.empty());
    expectError(ErrorKind::Input,
                fmt::format("volume[1].name is '{}', which Cryptomatte gives the same id", second),
                [&] {
                    layersOf(
                        fmt::format("[[volume]]\nname = \"{}\"\nfile = \"b.vdb\"\n"
                                    "[[volume]]\nname = \"{}\"\nfile = \"c.vdb\"\n",
                                    first, second));
                });
}

}  // namespace

}  // namespace woodcock::test
