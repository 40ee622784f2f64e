// SPDX-License-Identifier: Apache-2.0
#include "tests/support/keys_guide.h"

#include <sstream>

#include "woodcock/image/layers.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::test {

using namespace scene;

namespace {

template <class D>
KeyList listOf() {
    const KeyTable<D>& table = keysOf<D>();
    KeyList list{table.id, table.tag, table.outer, table.least, table.path, {}};
    for (const Key<D>& key : table.keys) {
        const auto same = [&](const KeyInfo& other) { return other.name == key.info.name; };
        if (std::none_of(list.keys.begin(), list.keys.end(), same)) list.keys.push_back(key.info);
    }
    return list;
}

template <class... D>
std::vector<KeyList> listsOf() {
    return {listOf<D>()...};
}

template <class... Kinds>
std::vector<KeyList> listsOfKinds(const std::variant<Kinds...>&) {
    return listsOf<Kinds...>();
}

/// Numbers and sentences as they are, TOML and names as code.
std::string fallbackCell(const KeyInfo& key) {
    const std::string& text = key.fallback;
    if (key.required) return "must be given";
    if (text == "\"\"") return "none";
    const bool isToml =
        text == "true" || text == "false" || text.starts_with('"') || text.starts_with('[');
    return isToml ? "`" + text + "`" : text;
}

std::string row(const KeyInfo& key) {
    return fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.type, fallbackCell(key), key.doc);
}

/// The table of the layers of an EXR.
std::string layersTable() {
    std::string text = "| layer | channels | precision | what it holds |\n|---|---|---|---|\n";
    for (const image::Layer& layer : image::layerTable())
        text += fmt::format("| `{}` | `{}` | {} | {} |\n", layer.name,
                            fmt::join(layer.channels, "`, `"), layer.exact ? "float" : "any",
                            layer.doc);
    return text +
           "| `lightgroup_NAME` | `lightgroup_NAME.R`, `.G`, `.B` | any | light of a group; "
           "`NAME` is its name, or `rest` |\n";
}

constexpr std::string_view beginMark = "<!-- keys: ", endMark = "<!-- end -->", markEnd = " -->";

}  // namespace

std::vector<KeyList> allKeys() {
    std::vector<KeyList> all =
        listsOf<SceneDescription, VolumeDescription, GridCoefficient, BlackbodyDescription, Box3d,
                SurfaceDescription, SphereShape, DiskShape, PlaneShape, LatheShape, mesh::FacetRing,
                Transform, InteriorDescription, MaterialDescription, TextureDescription,
                LightDescription, CameraDescription, RenderDescription, OutputDescription>();
    for (KeyList& list : listsOfKinds(MaterialDescription().material)) all.push_back(list);
    for (KeyList& list : listsOfKinds(LightDescription().light)) all.push_back(list);
    for (KeyList& list : listsOfKinds(PhaseDescription())) all.push_back(list);
    return all;
}

std::string guideTable(const KeyList& list) {
    std::string text = "| key | value | default | what it says |\n|---|---|---|---|\n";
    if (!list.tag.empty())
        text += fmt::format("| `type` | `\"{}\"` | must be given | |\n", list.tag);
    for (const KeyInfo& key : list.keys) text += row(key);
    return text;
}

std::string withGuideTables(const std::string& guide) {
    const std::vector<KeyList> all = allKeys();
    std::istringstream lines(guide);
    std::string text;
    bool inTable = false;
    for (std::string line; std::getline(lines, line);) {
        if (line == endMark) inTable = false;
        if (!inTable) text += line + '\n';
        if (!line.starts_with(beginMark)) continue;
        const std::string id =
            line.substr(beginMark.size(), line.size() - beginMark.size() - markEnd.size());
        inTable = true;
        if (id == "layers") {
            text += layersTable();
            continue;
        }
        const auto list = std::find_if(all.begin(), all.end(),
                                       [&](const KeyList& each) { return each.id == id; });
        if (list == all.end()) throw inputError("there is no table of keys '{}'", id);
        text += guideTable(*list);
    }
    if (inTable) throw inputError("the last table of keys has no '{}' behind it", endMark);
    return text;
}

}  // namespace woodcock::test
