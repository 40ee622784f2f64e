// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/image_format.h"
#include "woodcock/image/layers.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using O = OutputDescription;
using Base = const std::filesystem::path&;

/// What `action` finds wrong with a value is said with its place.
template <class Action>
void check(const TomlValue& value, Action action) {
    try {
        action();
    } catch (const Error& e) {
        throw inputError("{}: {}: {}", value.place(), value.name(), e.what());
    }
}

std::filesystem::path readFile(const TomlValue& value, Base base) {
    check(value, [&] { image::imageFormat(value.text()); });
    return value.path(base);
}

Value<std::vector<std::filesystem::path>> files() {
    return {"list",
            {"[\"a.exr\", \"folder/b.png\"]"},
            [](const TomlValue& v, Base base) {
                std::vector<std::filesystem::path> all;
                for (const TomlValue& file : v.elements("a list of files, such as [\"smoke.exr\"]"))
                    all.push_back(readFile(file, base));
                return all;
            },
            [](const std::vector<std::filesystem::path>& all, const SceneWriter& out) {
                std::vector<std::string> items;
                for (const auto& file : all) items.push_back(out.quoted(file));
                return fmt::format("[{}]", fmt::join(items, ", "));
            }};
}

std::vector<std::string> readLayers(const TomlValue& value, Base) {
    if (value.isText()) {
        check(value, [&] { image::parseLayerNames({value.text()}); });
        return {value.text()};
    }
    std::vector<std::string> layers;
    for (const TomlValue& element : value.elements("a list of layers, such as [\"depth\"]")) {
        layers.push_back(element.text());
        check(element, [&] { image::parseLayerName(layers.back()); });
    }
    check(value, [&] { image::parseLayerNames(layers); });
    return layers;
}

Value<std::vector<std::string>> layers() {
    return {"list, or a word",
            {"[\"depth\", \"error\"]"},
            readLayers,
            [](const std::vector<std::string>& all, const SceneWriter&) {
                std::vector<std::string> items;
                for (const std::string& layer : all) items.push_back(tomlText(layer));
                return fmt::format("[{}]", fmt::join(items, ", "));
            }};
}

std::vector<Key<O>> outputKeys() {
    const std::string own = "the config's own";
    std::vector<Key<O>> keys{
        key({.name = "files",
             .doc = "images to write. The extension is the format: `.exr`, or a picture: `.png`, "
                    "`.jpg`, `.tif` (16 bits), `.webp`. `-o` replaces the list. Missing folders "
                    "are refused, unless `--mkdir` makes them",
             .fallback = "none"},
            &O::files, files()),
        key({.name = "layers",
             .doc = "of the EXR beside R, G, B and A: see \"Layers\"",
             .fallback = "none"},
            &O::layers, layers()),
        key({.name = "half",
             .doc = "the colour of EXR files, and layers that half precision does not harm, are in "
                    "half precision"},
            &O::half, flag()),
        key({.name = "multipart", .doc = "each layer of EXR files is a part of its own"},
            &O::multipart, flag()),
        key({.name = "display", .doc = "OpenColorIO name, for pictures", .fallback = own},
            &O::display, text()),
        key({.name = "view", .doc = "OpenColorIO name, for pictures", .fallback = own}, &O::view,
            text()),
        key({.name = "look",
             .doc = "OpenColorIO name, for pictures. `\"none\"` takes no look, not even the view's "
                    "own",
             .fallback = own},
            &O::look, text()),
        key({.name = "exposure",
             .doc = "in stops, before the display transform. For pictures only",
             .comment = "stops"},
            &O::exposure, number({-100, 100})),
    };
    for (Key<O>& key : keys) key.info.inDigest = false;
    return keys;
}

}  // namespace

template <>
const KeyTable<O>& keysOf() {
    static const KeyTable<O> table{.id = "output",
                                   .where = "[output]",
                                   .keys = outputKeys(),
                                   .outer = "[[surface]]\nsphere = {}\n[output]\n",
                                   .path = "output"};
    return table;
}

template <>
const KeyTable<SceneDescription>& keysOf() {
    static const KeyTable<SceneDescription> table{
        .id = "scene",
        .where = "the scene",
        .keys = {key({.name = "ocio",
                      .doc = "an OpenColorIO config, for pictures: all outputs but EXR",
                      .fallback = "`$OCIO`, then the one that comes with the program",
                      .inDigest = false},
                     &SceneDescription::ocio, path())},
        .outer = "[[surface]]\nsphere = {}\n"};
    return table;
}

}  // namespace woodcock::scene
