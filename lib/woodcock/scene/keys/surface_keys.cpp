// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/nearest_name.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using S = SurfaceDescription;
using Base = const std::filesystem::path&;

constexpr int mostPriority = 1'000'000;

/// An angle in degrees, "flat", or "file".
std::optional<double> readSmooth(const TomlValue& value, const S& surface) {
    const bool file = std::holds_alternative<MeshShape>(surface.shape);
    if (!file && !std::holds_alternative<LatheShape>(surface.shape))
        throw value.error(
            "is for surfaces of a file or a lathe; the normals of other shapes are exact");
    if (!value.isText()) return value.number({0, 180});
    const std::array<std::string, 2> words{"flat", "file"};
    if (value.choice("smoothing", words) == 0) return 0;
    if (!file) throw value.error("is \"file\", but the surface is a lathe");
    return std::nullopt;
}

Key<S> smooth() {
    Key<S> key;
    key.info = {.name = "smooth",
                .doc =
                    "for files and lathes. An angle in degrees: neighbouring triangles that differ "
                    "by less look like one smooth surface. `\"flat\"` shows each triangle. "
                    "`\"file\"` takes the normals of the file",
                .type = "number, 0..180, or a word",
                .fallback = "`\"file\"`; 60 for lathes and level sets",
                .example = "33.3",
                .beside = "file = \"a.obj\""};
    key.read = [](const TomlValue& v, S& s, Base) { s.smooth = readSmooth(v, s); };
    key.write = [](const S& s, const SceneWriter&) -> std::optional<Written> {
        if (!s.smooth) return std::nullopt;
        return Written{*s.smooth == 0 ? tomlText("flat") : tomlNumber(*s.smooth)};
    };
    return key;
}

void readInstances(const TomlValue& value, S& surface, Base base) {
    if (value.isText()) {
        surface.instanceFile = value.path(base);
        return;
    }
    for (const TomlValue& element :
         value.elements("a list of transforms and matrices, or a file's name"))
        surface.instances.push_back(element.isTable() ? readTransform(element, "surface")
                                                      : element.affine());
    if (surface.instances.empty())
        throw value.error("is empty; leave it out, and the surface stands there once");
}

std::optional<Written> writeInstances(const S& surface, const SceneWriter& out) {
    if (!surface.instanceFile.empty()) return Written{out.quoted(surface.instanceFile)};
    if (surface.instances.empty()) return std::nullopt;
    std::string all = "[";
    for (const Affine3d& instance : surface.instances) all += "\n    " + tomlMatrix(instance) + ",";
    return Written{all + "\n]"};
}

Key<S> instances() {
    return {{.name = "instances",
             .doc = "where copies of it stand, each placed before `transform`. A list of "
                    "transforms (`{ translate, rotate, scale }`) and matrices, or the name of a "
                    "text file with a line for each: `x y z`, `x y z scale`, `x y z scale rx ry "
                    "rz`, or the 12 numbers of a matrix's upper three rows. `#` begins a comment",
             .type = "list or path",
             .fallback = "once",
             .example = "[{ rotate = [0, 33, 0] }, { scale = 2 }]"},
            readInstances,
            writeInstances};
}

std::vector<Key<S>> contentKeys() {
    return {
        key({.name = "medium",
             .doc = "what it holds: `{ sigma_a, sigma_s, g }`, or `{ scale, albedo, g }`, or `{ "
                    "colour, distance }`, to which you may add `sigma_s` and `g`. `emission` goes "
                    "with any of them, or alone",
             .fallback = "vacuum",
             .comment = "1/unit",
             .example = "{ sigma_a = 1, sigma_s = [1, 2, 3], g = 0.1 }",
             .beside = "sphere = {}\nmaterial = \"glass\"\n[[material]]\nname = \"glass\"\n"
                       "type = \"dielectric\""},
            &S::interior, nested<InteriorDescription>()),
        key({.name = "priority",
             .doc = "the highest wins where several surfaces hold something, or lie in one place"},
            &S::priority, integer(-mostPriority, mostPriority)),
    };
}

std::vector<Key<S>> compositingKeys() {
    return {
        key({.name = "holdout",
             .doc = "the camera sees a hole in its place, with alpha 0, and nothing of what is "
                    "behind"},
            &S::holdout, flag()),
        key({.name = "shadow_catcher", .doc = "the camera sees only the shadows that fall on it"},
            &S::shadowCatcher, flag()),
        key({.name = "matte", .doc = "the camera sees it black, with alpha 1"}, &S::matte, flag()),
        key({.name = "camera_visible",
             .doc = "`false`: the camera does not see it, but its light and its shadow remain. A "
                    "surface takes one of these four keys at most"},
            &S::cameraVisible, flag()),
    };
}

/// Before the keys are read: one shape.
void checkShape(const TomlTable& table) {
    std::vector<std::string> known, given;
    for (const Key<S>& key : shapeKeys()) {
        if (key.info.name == "level_set") continue;
        known.push_back(key.info.name);
        if (table.has(key.info.name)) given.push_back(key.info.name);
    }
    if (given.empty())
        throw table.error(
            "has no shape; give one of {}, such as file = \"mesh.obj\" or "
            "sphere = {{ centre = [0, 0, 0], radius = 1 }}",
            joinNames(known));
    if (given.size() > 1)
        table.exclude(given[1], given[0], "a surface has one shape, and others are surfaces too");
    if (const auto v = table.find("level_set"); v && given[0] != "file")
        throw v->error("needs a file: it names a grid of a VDB file");
}

void checkLevelSet(const TomlTable& table, const S& surface) {
    const auto v = table.find("level_set");
    if (!v) return;
    const std::filesystem::path& file = std::get<MeshShape>(surface.shape).file;
    if (file.extension() != ".vdb" && file.extension() != ".nvdb")
        throw v->error("names a grid of a VDB file, but file is '{}'", file.string());
}

void checkCompositing(const TomlTable& table, const S& surface) {
    std::string chosen = surface.cameraVisible ? "" : "camera_visible = false";
    const auto flag = [&](const char* key, bool value) {
        if (!value) return;
        if (!chosen.empty())
            throw table.find(key)->error(
                "is true, but so is {}: each says what the camera sees of the surface, "
                "and they contradict each other",
                chosen);
        chosen = key;
    };
    flag("holdout", surface.holdout);
    flag("shadow_catcher", surface.shadowCatcher);
    flag("matte", surface.matte);
}

void checkSurface(const TomlTable& table, S& surface) {
    checkLevelSet(table, surface);
    checkCompositing(table, surface);
}

std::vector<Key<S>> surfaceKeys() {
    return joined(std::vector{key({.name = "name",
                                   .doc = "for `inside` of volumes, and for messages",
                                   .fallback = "none"},
                                  &S::name, text())},
                  shapeKeys(),
                  std::vector{key({.name = "material",
                                   .doc = "name of a `[[material]]`",
                                   .fallback = "diffuse, 0.8",
                                   .example = "\"paint\"",
                                   .beside = "disk = {}\n[[material]]\nname = \"paint\"\n"
                                             "type = \"conductor\""},
                                  &S::material, text()),
                              smooth()},
                  placementKeys(&S::worldFromObject, "surface", "`{ translate, rotate, scale }`"),
                  std::vector{instances()}, contentKeys(), compositingKeys());
}

}  // namespace

template <>
const KeyTable<S>& keysOf() {
    static const KeyTable<S> table{
        .id = "surface",
        .where = "[[surface]]",
        .exclusions = {{"transform", "matrix", "both place the surface"}},
        .keys = surfaceKeys(),
        .check = checkSurface,
        .outer = "[[surface]]\n",
        .least = "box = { min = [0, 0, 0], max = [1, 1, 1] }",
        .path = "surface[0]"};
    return table;
}

SurfaceDescription readSurface(const TomlTable& table, Base base) {
    SurfaceDescription surface;
    allowKeys(table, surface, keysOf<S>().where);
    checkShape(table);
    readAllowed(table, surface, base);
    return surface;
}

}  // namespace woodcock::scene
