// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/scene/description.h"
#include "woodcock/scene/keys/key.h"

namespace woodcock::scene {

// The tables of keys, and the sections of a scene file that take more than one of them.

template <>
const KeyTable<RenderDescription>& keysOf();
template <>
const KeyTable<OutputDescription>& keysOf();
template <>
const KeyTable<CameraDescription>& keysOf();
template <>
const KeyTable<SceneDescription>& keysOf();  ///< those that stand before all sections

template <>
const KeyTable<VolumeDescription>& keysOf();
template <>
const KeyTable<GridCoefficient>& keysOf();
template <>
const KeyTable<BlackbodyDescription>& keysOf();
template <>
const KeyTable<Box3d>& keysOf();

template <>
const KeyTable<IsotropicPhase>& keysOf();
template <>
const KeyTable<HenyeyGreensteinPhase>& keysOf();
template <>
const KeyTable<TwoLobePhase>& keysOf();
template <>
const KeyTable<RayleighPhase>& keysOf();
template <>
const KeyTable<DrainePhase>& keysOf();
template <>
const KeyTable<MiePhase>& keysOf();
template <>
const KeyTable<FournierForandPhase>& keysOf();
template <>
const KeyTable<TablePhase>& keysOf();
/// The value of a key `phase`: a table with the kind's `type` and keys.
Value<PhaseDescription> phaseFunction();

template <>
const KeyTable<LightDescription>& keysOf();  ///< those that all types have
template <>
const KeyTable<SunDescription>& keysOf();
template <>
const KeyTable<PointDescription>& keysOf();
template <>
const KeyTable<SpotDescription>& keysOf();
template <>
const KeyTable<SphereDescription>& keysOf();
template <>
const KeyTable<RectangleDescription>& keysOf();
template <>
const KeyTable<DiskDescription>& keysOf();
template <>
const KeyTable<EnvironmentDescription>& keysOf();

template <>
const KeyTable<MaterialDescription>& keysOf();  ///< those that all types have
template <>
const KeyTable<TextureDescription>& keysOf();
template <>
const KeyTable<DiffuseDescription>& keysOf();
template <>
const KeyTable<ConductorDescription>& keysOf();
template <>
const KeyTable<DielectricDescription>& keysOf();
template <>
const KeyTable<InterfaceDescription>& keysOf();
template <>
const KeyTable<EmissiveDescription>& keysOf();
template <>
const KeyTable<MixDescription>& keysOf();

template <>
const KeyTable<SkyDescription>& keysOf();

template <>
const KeyTable<SurfaceDescription>& keysOf();
template <>
const KeyTable<SphereShape>& keysOf();
template <>
const KeyTable<DiskShape>& keysOf();
template <>
const KeyTable<PlaneShape>& keysOf();
template <>
const KeyTable<LatheShape>& keysOf();
template <>
const KeyTable<mesh::FacetRing>& keysOf();
template <>
const KeyTable<InteriorDescription>& keysOf();

/// The keys of a surface that are its shape, of which it has one; and `level_set`, of a file.
std::vector<Key<SurfaceDescription>> shapeKeys();

/// The lists of tables that a scene has: [[volume]] and so on.
inline const std::array<std::string, 4> sceneLists{"volume", "material", "surface", "light"};

/// The types of a variant's kinds, in its order.
template <class... Kinds>
std::vector<std::string> tagsOf(const std::variant<Kinds...>&) {
    return {keysOf<Kinds>().tag...};
}

template <class... Kinds>
const std::string& tagOf(const std::variant<Kinds...>& kind) {
    return std::visit(
        [](const auto& k) -> const std::string& {
            return keysOf<std::remove_cvref_t<decltype(k)>>().tag;
        },
        kind);
}

/// Reads the kind that the table's `type` says; `others` are keys that are read elsewhere. Throws
/// Error{Input}.
template <class... Kinds>
void readTagged(const TomlTable& table, std::string_view what, std::variant<Kinds...>& kind,
                const std::filesystem::path& base, std::vector<std::string> others = {}) {
    const std::vector<std::string> tags = tagsOf(kind);
    const size_t chosen = table.need("type", "type = " + tomlText(tags[0])).choice(what, tags);
    others.push_back("type");
    const auto read = [&]<class Kind>(std::type_identity<Kind>) {
        if (keysOf<Kind>().tag != tags[chosen]) return;
        Kind value;
        readKeys(table, value, base, others);
        kind = std::move(value);
    };
    (read(std::type_identity<Kinds>()), ...);
}

/// Writes a kind as its `type` and its keys.
template <class... Kinds>
void writeTagged(SceneWriter& out, const std::variant<Kinds...>& kind) {
    out.line("type", tomlText(tagOf(kind)));
    std::visit([&](const auto& k) { writeKeys(out, k); }, kind);
}

// One section each; all throw Error{Input}.

VolumeDescription readVolume(const TomlTable& table, const std::filesystem::path& base);
MaterialDescription readMaterial(const TomlTable& table, const std::filesystem::path& base);
SurfaceDescription readSurface(const TomlTable& table, const std::filesystem::path& base);
LightDescription readLight(const TomlTable& table, const std::filesystem::path& base);
/// All [[light]] sections.
std::vector<LightDescription> readLights(const TomlTable& scene, const std::filesystem::path& base);
/// `aspect` is the image's width over its height: a sensor's width needs it.
CameraDescription readCamera(const TomlTable& table, double aspect);

}  // namespace woodcock::scene
