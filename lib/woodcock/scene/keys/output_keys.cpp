// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/cryptomatte.h"
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

Value<std::filesystem::path> exrFile() {
    return {
        "file name",
        {"\"layers/more.exr\""},
        [](const TomlValue& v, Base base) {
            std::filesystem::path file = readFile(v, base);
            if (image::imageFormat(file) != image::ImageFormat::Exr)
                throw v.error("is '{}'; it has to be an EXR file (.exr)", v.text());
            return file;
        },
        [](const std::filesystem::path& file, const SceneWriter& out) { return out.quoted(file); }};
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

std::string writeWords(const std::vector<std::string>& words, const SceneWriter&) {
    std::vector<std::string> items;
    for (const std::string& word : words) items.push_back(tomlText(word));
    return fmt::format("[{}]", fmt::join(items, ", "));
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
            writeWords};
}

/// Some of the `known` words, none twice; `what` names one, as "layer".
Value<std::vector<std::string>> words(const std::string& what,
                                      const std::vector<std::string>& known,
                                      const std::string& example) {
    return {"list",
            {example},
            [=](const TomlValue& value, Base) {
                std::vector<std::string> all;
                for (const TomlValue& element :
                     value.elements(fmt::format("a list of {}s, such as {}", what, example))) {
                    const std::string& word = known[element.choice(what, known)];
                    if (std::find(all.begin(), all.end(), word) != all.end())
                        throw element.error("repeats the {} '{}'", what, word);
                    all.push_back(word);
                }
                return all;
            },
            writeWords};
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
        key({.name = "mattes",
             .doc = "Cryptomatte in the EXR files: coverage by `\"object\"`, by `\"material\"`, or "
                    "both; see \"Mattes\"",
             .fallback = "none"},
            &O::mattes, words("matte", image::matteKinds(), "[\"object\", \"material\"]")),
        key({.name = "mattes_file",
             .doc = "an EXR file for the mattes alone. The other EXR files then hold none",
             .fallback = "none"},
            &O::mattesFile, exrFile()),
        key({.name = "deep",
             .doc = "an EXR file for deep pixels, see \"Deep pixels\"",
             .fallback = "none"},
            &O::deep, exrFile()),
        key({.name = "deep_error",
             .doc = "how far the transmittance of deep pixels may be off at any depth; and the "
                    "depth of surfaces, relatively"},
            &O::deepError, number({1e-4, 0.5})),
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
