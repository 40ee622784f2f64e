// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using S = SurfaceDescription;
using Base = const std::filesystem::path&;
using Profile = std::vector<std::array<double, 2>>;
using Rings = std::vector<mesh::FacetRing>;

constexpr int mostSegments = 100'000, mostFacets = 1000;

/// The shape of a surface that has this one.
template <class Shape>
const void* memberOf(const S& s) {
    return std::get_if<Shape>(&s.shape);
}

/// A shape, as the value of the key that is its name.
template <class Shape>
Key<S> shapeKey(KeyInfo info) {
    if (info.fallback.empty()) info.fallback = "none";
    Key<S> key;
    key.info = std::move(info);
    key.read = [](const TomlValue& v, S& s, Base base) { s.shape = nested<Shape>().read(v, base); };
    key.write = [](const S& s, const SceneWriter& out) -> std::optional<Written> {
        const auto* shape = std::get_if<Shape>(&s.shape);
        return shape ? std::optional(Written{inlineTable(*shape, out)}) : std::nullopt;
    };
    key.member = memberOf<Shape>;
    return key;
}

Key<S> box() {
    Key<S> key;
    key.info = {
        .name = "box", .type = bounds().type, .fallback = "none", .examples = bounds().examples};
    key.read = [](const TomlValue& v, S& s, Base base) {
        s.shape = BoxShape{bounds().read(v, base)};
    };
    key.write = [](const S& s, const SceneWriter& out) -> std::optional<Written> {
        const auto* shape = std::get_if<BoxShape>(&s.shape);
        return shape ? std::optional(Written{bounds().write(shape->box, out)}) : std::nullopt;
    };
    key.member = memberOf<BoxShape>;
    return key;
}

Key<S> facets() {
    Key<S> key;
    key.info = {.name = "facets",
                .doc =
                    "a convex body, described as gem cutters do: rings `{ angle, count, distance, "
                    "turn }` of facets around y",
                .type = "list",
                .fallback = "none",
                .example =
                    "[{ angle = 0, distance = 1 }, { angle = 120, count = 3, distance = 2, "
                    "turn = 10 }]",
                .beside = "facets = [{ angle = 90, distance = 1 }]"};
    key.read = [](const TomlValue& v, S& s, Base base) {
        FacetShape shape;
        for (const TomlValue& ring : v.elements("a list of rings of facets"))
            shape.rings.push_back(nested<mesh::FacetRing>().read(ring, base));
        s.shape = shape;
    };
    key.write = [](const S& s, const SceneWriter& out) -> std::optional<Written> {
        const auto* shape = std::get_if<FacetShape>(&s.shape);
        if (!shape) return std::nullopt;
        std::string all = "[";
        for (const mesh::FacetRing& ring : shape->rings)
            all += "\n    " + inlineTable(ring, out) + ",";
        return Written{all + "\n]"};
    };
    key.member = memberOf<FacetShape>;
    return key;
}

Profile readProfile(const TomlValue& value, Base) {
    Profile profile;
    for (const TomlValue& point : value.elements("a list of [radius, height]")) {
        const auto pair = point.elements("[radius, height]", 2);
        profile.push_back({pair[0].number(notNegative), pair[1].number()});
    }
    if (profile.size() < 2)
        throw value.error("has {} points; a lathe needs two at least", profile.size());
    return profile;
}

Value<Profile> profile() {
    return {
        "list of `[radius, height]`", {}, readProfile, [](const Profile& all, const SceneWriter&) {
            std::vector<std::string> points;
            for (const auto& [radius, height] : all)
                points.push_back(fmt::format("[{}, {}]", tomlNumber(radius), tomlNumber(height)));
            return fmt::format("[{}]", fmt::join(points, ", "));
        }};
}

/// The scene in which such a shape stands.
std::string outerOf(const std::string& shape) { return "[[surface]]\n[surface." + shape + "]\n"; }

}  // namespace

std::vector<Key<S>> shapeKeys() {
    const auto file = [](auto member) {
        return [=](auto& s) {
            if constexpr (!std::is_const_v<std::remove_reference_t<decltype(s)>>)
                if (!std::holds_alternative<MeshShape>(s.shape)) s.shape = MeshShape();
            auto* mesh = std::get_if<MeshShape>(&s.shape);
            return mesh ? &(mesh->*member) : nullptr;
        };
    };
    return {
        keyAt<S>({.name = "file",
                  .doc = "a mesh (OBJ, PLY, STL, glTF), or a VDB, whose level set is the surface",
                  .fallback = "this or another shape must be given",
                  .example = "\"b $$5.obj\"",
                  .beside = "file = \"a.obj\""},
                 file(&MeshShape::file), path()),
        keyAt<S>({.name = "level_set",
                  .doc = "name of a grid, where a VDB has several level sets",
                  .fallback = "none",
                  .beside = "file = \"a.vdb\""},
                 file(&MeshShape::levelSet), text()),
        shapeKey<SphereShape>({.name = "sphere",
                               .type = "`{ centre = [x, y, z], radius = 1 }`",
                               .example = "{ centre = [1, 2, 3], radius = 2 }",
                               .beside = "sphere = {}"}),
        box(),
        shapeKey<DiskShape>({.name = "disk",
                             .doc = "in the plane y = 0, facing +y. It encloses nothing",
                             .type = "`{ radius = 1 }`",
                             .example = "{ radius = 2 }",
                             .beside = "disk = {}"}),
        shapeKey<PlaneShape>({.name = "plane",
                              .doc = "in the plane y = 0 about the origin, facing +y. `{}` is "
                                     "infinite, and all below it is inside",
                              .type = "`{ size = [width, depth] }`",
                              .example = "{ size = [2, 0.1] }",
                              .beside = "plane = {}"}),
        shapeKey<LatheShape>({.name = "lathe",
                              .doc = "a profile that is turned about y",
                              .type = "`{ profile = [[radius, height], ...], segments = 96 }`",
                              .example = "{ profile = [[0, 0], [1, 0.1], [0, 2]], segments = 7 }",
                              .beside = "lathe = { profile = [[0, 0], [1, 1]] }"}),
        facets(),
    };
}

template <>
const KeyTable<SphereShape>& keysOf() {
    static const KeyTable<SphereShape> table{
        .id = "surface.sphere",
        .keys =
            {key({.name = "centre", .doc = "in object space, before `transform`", .always = true},
                 &SphereShape::centre, vector()),
             key({.name = "radius", .doc = "in object space, before `transform`", .always = true},
                 &SphereShape::radius, number(positive))},
        .outer = outerOf("sphere"),
        .path = "surface[0].sphere"};
    return table;
}

template <>
const KeyTable<DiskShape>& keysOf() {
    static const KeyTable<DiskShape> table{
        .id = "surface.disk",
        .keys = {key(
            {.name = "radius", .doc = "in object space, before `transform`", .always = true},
            &DiskShape::radius, number(positive))},
        .outer = outerOf("disk"),
        .path = "surface[0].disk"};
    return table;
}

template <>
const KeyTable<PlaneShape>& keysOf() {
    static const KeyTable<PlaneShape> table{
        .id = "surface.plane",
        .keys = {key({.name = "size", .doc = "its sides along x and z", .fallback = "infinite"},
                     &PlaneShape::size, numberPair("[width, depth]", positive))},
        .outer = outerOf("plane"),
        .path = "surface[0].plane"};
    return table;
}

template <>
const KeyTable<LatheShape>& keysOf() {
    static const KeyTable<LatheShape> table{
        .id = "surface.lathe",
        .keys = {key({.name = "profile",
                      .doc = "its points in order, with the outside on the right: so upwards, "
                             "where the inside is at the axis. The body is closed if both ends lie "
                             "on the axis, or if the profile ends where it begins",
                      .example = "[[0, 0], [1, 0], [1, 2], [0, 2]]",
                      .required = true,
                      .always = true},
                     &LatheShape::profile, profile()),
                 key({.name = "segments", .doc = "how many, around the axis", .always = true},
                     &LatheShape::segments, integer(3, mostSegments))},
        .outer = outerOf("lathe"),
        .least = "profile = [[0, 0], [1, 1]]",
        .path = "surface[0].lathe"};
    return table;
}

template <>
const KeyTable<mesh::FacetRing>& keysOf() {
    static const KeyTable<mesh::FacetRing> table{
        .id = "surface.facets",
        .keys = {key({.name = "angle",
                      .doc = "of the outward normal from +y, in degrees: 0 is a table, 90 the "
                             "girdle, 180 a culet",
                      .example = "34.5",
                      .required = true,
                      .always = true},
                     &mesh::FacetRing::angle, number({0, 180})),
                 key({.name = "count", .doc = "how many facets, evenly around y", .always = true},
                     &mesh::FacetRing::count, integer(1, mostFacets)),
                 key({.name = "distance",
                      .doc = "of their planes from the origin",
                      .example = "1",
                      .required = true,
                      .always = true},
                     &mesh::FacetRing::distance, number(positive)),
                 key({.name = "turn",
                      .doc = "of the first normal from +z towards +x, in degrees",
                      .always = true},
                     &mesh::FacetRing::turn, number())},
        .outer = "[[surface]]\n[[surface.facets]]\n",
        .least = "angle = 10\ndistance = 2",
        .path = "surface[0].facets[0]"};
    return table;
}

}  // namespace woodcock::scene
