// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/keys_guide.h"
#include "tests/support/paths.h"
#include "woodcock/scene/parse.h"
#include "woodcock/scene/write.h"

namespace woodcock::test {

using namespace scene;

namespace {

/// Without the places, which tell where a value was written and not what it is.
SceneDescription parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    SceneDescription scene = parseSceneText(text, "keys.toml", ".", overrides);
    scene.places.clear();
    return scene;
}

/// The scene in which a key is tried, before it is set.
std::string sceneBefore(const KeyList& list, const KeyInfo& key) {
    const std::string tag = list.tag.empty() ? "" : "type = \"" + list.tag + "\"\n";
    return list.outer + tag + key.beside.value_or(list.least) + "\n";
}

/// What --set says to give the key a value.
std::string assignment(const KeyList& list, const KeyInfo& key, const std::string& value) {
    return list.path + (list.path.empty() ? "" : ".") + key.name + "=" + value;
}

/// The first example that is not what the key says without it; what it gives is of `changed`.
bool changes(const KeyList& list, const KeyInfo& key, SceneDescription& changed) {
    const std::string text = sceneBefore(list, key);
    const SceneDescription before = parse(text);
    std::vector<std::string> values = key.examples;
    if (!key.example.empty()) values = {key.example};
    for (const std::string& value : values) {
        changed = parse(text, {assignment(list, key, value)});
        if (!(changed == before)) return true;
    }
    return false;
}

template <class Try>
void forEachKey(Try tryKey) {
    for (const KeyList& list : allKeys())
        for (const KeyInfo& key : list.keys) {
            SCOPED_TRACE(list.id + ": " + key.name);
            EXPECT_NO_THROW(tryKey(list, key));
        }
}

TEST(SceneKeys, EachSaysSomethingThatIsWrittenAndReadBack) {
    forEachKey([](const KeyList& list, const KeyInfo& key) {
        SceneDescription scene;
        if (key.permission)
            scene = parse(sceneBefore(list, key), {assignment(list, key, key.example)});
        else
            ASSERT_TRUE(changes(list, key, scene));
        EXPECT_EQ(parse(writeScene(scene)), scene) << writeScene(scene);
    });
}

TEST(SceneKeys, EachHasItsSayInTheDigestOrIsMarkedAsHavingNone) {
    forEachKey([](const KeyList& list, const KeyInfo& key) {
        if (key.permission) return;
        SceneDescription scene;
        ASSERT_TRUE(changes(list, key, scene));
        const std::string before = sceneDigest(parse(sceneBefore(list, key)));
        EXPECT_EQ(sceneDigest(scene) != before, key.inDigest);
    });
}

TEST(SceneKeys, APermissionIsNeeded) {
    forEachKey([](const KeyList& list, const KeyInfo& key) {
        if (!key.permission) return;
        EXPECT_THROW(parse(sceneBefore(list, key)), Error);
    });
}

TEST(SceneKeys, StandInTheGuideAsInTheirTables) {
    const std::filesystem::path file = sourceDir() / "data/scenes/README.md";
    const std::string guide = readText(file), made = withGuideTables(guide);
    if (std::getenv("WOODCOCK_WRITE_GUIDE")) std::ofstream(file, std::ios::binary) << made;
    EXPECT_TRUE(made == guide) << "the tables of " << file
                               << " are not those of lib/woodcock/scene/keys; run this test with "
                                  "WOODCOCK_WRITE_GUIDE=1 to write them anew";
    for (const KeyList& list : allKeys())
        EXPECT_NE(guide.find("<!-- keys: " + list.id + " -->"), std::string::npos)
            << "the guide has no table of " << list.id;
}

}  // namespace
}  // namespace woodcock::test
