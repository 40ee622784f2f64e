// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/base/nearest_name.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using S = SurfaceDescription;
using I = InteriorDescription;
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
            writeInstances,
            [](const S& s) { return static_cast<const void*>(&s.instances); },
            [](S& s, Files& files) {
                if (!s.instanceFile.empty()) files.push_back(&s.instanceFile);
            }};
}

std::vector<Key<S>> contentKeys() {
    return {
        key({.name = "medium",
             .doc = "what it holds: `{ sigma_a, sigma_s, g }`, or `{ scale, albedo, g }`, or `{ "
                    "colour, distance }`, to which you may add `sigma_s` and `g`. `phase` may "
                    "stand in place of `g`. `emission` goes "
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

// ---- what it holds

Key<I> instead(std::string name, std::string doc, std::string type, std::string example,
               std::string beside) {
    return otherWay<I>({.name = std::move(name),
                        .doc = std::move(doc),
                        .type = std::move(type),
                        .fallback = "none",
                        .example = std::move(example),
                        .beside = std::move(beside)});
}

std::vector<Key<I>> interiorKeys() {
    const std::string dyed = "colour = 0.5\ndistance = 1";
    return {
        key({.name = "sigma_a", .doc = "absorption per world unit", .always = true}, &I::sigmaA,
            colour(notNegative)),
        key({.name = "sigma_s", .doc = "scattering per world unit", .always = true}, &I::sigmaS,
            colour(notNegative)),
        instead("scale", "instead of `sigma_a` and `sigma_s`: sigma_t", colour(notNegative).type,
                "2", "scale = 1"),
        instead("albedo", "beside `scale`: sigma_s = albedo x scale", colour(zeroToOne).type, "0.5",
                "scale = 1"),
        instead("colour",
                "instead of `sigma_a`: what white light has become after `distance`. sigma_a = "
                "-ln(colour) / distance",
                colour(zeroToOne).type, "[0.1, 0.2, 0.3]", dyed),
        instead("distance", "beside `colour`, in world units", number(positive).type, "2", dyed),
        key({.name = "g", .doc = "mean cosine of scattering"}, &I::g, meanCosine()),
        key({.name = "phase", .doc = "instead of `g`: another phase function, as of a volume"},
            &I::phase, phaseFunction()),
        key({.name = "emission",
             .doc = "radiance per world unit. Within glass of index n it looks n^2 times darker "
                    "from outside"},
            &I::emission, colour(notNegative)),
        key({.name = "group",
             .doc = "the light group that `emission` counts to; see \"Light groups\"",
             .beside = "emission = 1"},
            &I::group, groupName()),
    };
}

/// What absorbs so that light of all colours becomes `colour` over `distance`.
Rgb absorptionOf(const TomlTable& medium, const TomlValue& colour) {
    const Vec3d rgb = colour.exactColour(zeroToOne);
    for (int i = 0; i < 3; ++i)
        if (rgb[i] == 0)
            throw colour.error(
                "is 0 in its {} channel, which would need infinite absorption; give what little "
                "comes through, such as 0.001",
                std::array{"red", "green", "blue"}[static_cast<size_t>(i)]);
    const auto distance = medium.find("distance");
    if (!distance)
        throw colour.error("needs a distance beside it: how far light goes to become so");
    const double d = distance->number(positive);
    const Rgb sigma =
        Rgb::map([&](int i) { return static_cast<float>(-std::log(rgb[i]) / d + 0.0); });
    if (!sigma.isFinite()) throw distance->error("is {}: too short for a float's sigma_a", d);
    return sigma;
}

void checkInterior(const TomlTable& table, I& interior) {
    const auto colour = table.find("colour"), distance = table.find("distance");
    if (distance && !colour)
        throw distance->error("needs a colour beside it: what light becomes over that distance");
    if (const auto group = table.find("group"); group && !table.has("emission"))
        throw group->error("is for emission; give emission, or leave it out");
    if (table.keys().empty() ||
        ((table.has("g") || table.has("phase")) && table.keys().size() == 1))
        throw table.error(
            "holds nothing; give sigma_a and sigma_s, scale and albedo, colour and distance, or "
            "emission, or leave it out");
    if (const auto sigma = readScaleAndAlbedo(table))
        std::tie(interior.sigmaA, interior.sigmaS) = *sigma;
    if (colour) interior.sigmaA = absorptionOf(table, *colour);
}

std::vector<Exclusion> interiorExclusions() {
    std::vector<Exclusion> all = coefficientExclusions();
    for (const char* key : {"sigma_a", "scale", "albedo"})
        all.push_back({"colour", key, "both say how much the medium absorbs"});
    all.push_back({"phase", "g", "both say how the medium scatters"});
    return all;
}

}  // namespace

template <>
const KeyTable<I>& keysOf() {
    static const KeyTable<I> table{
        .id = "surface.medium",
        .exclusions = interiorExclusions(),
        .keys = interiorKeys(),
        .check = checkInterior,
        .outer =
            "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\n"
            "[[surface]]\nsphere = {}\nmaterial = \"glass\"\n[surface.medium]\n",
        .least = "sigma_a = 1",
        .path = "surface[0].medium"};
    return table;
}

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
