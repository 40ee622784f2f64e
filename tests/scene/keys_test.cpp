// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>

#include "tests/support/expect_error.h"
#include "tests/support/keys_guide.h"
#include "tests/support/paths.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/scene_file.h"

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

TEST(SceneKeys, EachThatNamesAFileToReadIsAmongTheScenesFiles) {
    int found = 0;
    forEachKey([&](const KeyList& list, const KeyInfo& key) {
        if (key.type.find("path") == std::string::npos || list.id == "output" || key.name == "ocio")
            return;
        SceneDescription scene =
            parse(sceneBefore(list, key), {assignment(list, key, "\"sought.file\"")});
        const std::vector<std::filesystem::path*> files = sceneFiles(scene);
        const auto isSought = [](const auto* file) { return file->filename() == "sought.file"; };
        EXPECT_EQ(std::count_if(files.begin(), files.end(), isSought), 1);
        ++found;
    });
    EXPECT_GE(found, 5);
}

TEST(SceneKeys, AreNamedByTheMembersThatTheySay) {
    RenderDescription render;
    EXPECT_EQ(keyName(render, render.maxBounces), "max_bounces");
    EXPECT_EQ(keyName(render, render.approximations.octaves), "octaves");
    expectError(ErrorKind::Usage, "no key of 'render' says this member",
                [&] { keyName(render, render.height); });
    SurfaceDescription surface;
    surface.shape = PlaneShape();
    EXPECT_EQ(keyName(surface, std::get<PlaneShape>(surface.shape)), "plane");
    EXPECT_EQ(keyName(surface, surface.instances), "instances");
    VolumeDescription volume;
    volume.blackbody.emplace();
    EXPECT_EQ(keyName(volume, volume.blackbody), "blackbody");
    EXPECT_EQ(keyName(*volume.blackbody, volume.blackbody->offset), "offset");
}

/// "volume[].scale" of "volume[{}].scale".
std::string withoutIndices(const std::string& path) {
    return std::regex_replace(path, std::regex(R"(\[[^\]]*\])"), "[]");
}

/// What a source may call a key of a scene: "render.spp", "volume[].emission.grid".
class KnownKeys {
public:
    KnownKeys() {
        for (const KeyList& list : allKeys()) {
            const std::string table = withoutIndices(list.path);
            if (!list.tag.empty()) paths_.insert(table + ".type");
            for (const KeyInfo& key : list.keys) {
                paths_.insert(table + "." + key.name);
                if (table.find('.') != std::string::npos) ofTablesWithin_.insert(key.name);
            }
        }
    }
    bool has(const std::string& path) const {
        if (paths_.contains(path)) return true;
        const size_t dot = path.rfind('.');
        return paths_.contains(path.substr(0, dot)) &&
               ofTablesWithin_.contains(path.substr(dot + 1));
    }

private:
    std::set<std::string> paths_, ofTablesWithin_;
};

TEST(SceneKeys, NamedInSourcesAreInTheTables) {
    const KnownKeys known;
    EXPECT_TRUE(known.has("volume[].emission.grid"));
    EXPECT_FALSE(known.has("render.bounces"));
    EXPECT_FALSE(known.has("volume[].emission.bounces"));
    const std::regex name(
        R"(["'`]((?:render|camera|output|(?:volume|material|surface|light)\[[^\]"\n]*\]))"
        R"((?:\.[a-z_]+)+))");
    int found = 0;
    for (const char* folder : {"lib/woodcock", "tools"})
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(sourceDir() / folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".cpp" && extension != ".h") continue;
            const std::string text = readText(entry.path());
            for (std::sregex_iterator i(text.begin(), text.end(), name), end; i != end;
                 ++i, ++found)
                EXPECT_TRUE(known.has(withoutIndices((*i)[1])))
                    << entry.path() << " speaks of " << (*i)[1];
        }
    EXPECT_GT(found, 20);
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
