// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/mattes.h"

#include <algorithm>
#include <map>
#include <optional>

#include "woodcock/base/frame_names.h"
#include "woodcock/base/nearest_name.h"

namespace woodcock::scene {

namespace {

/// Something that a matte can show.
struct Named {
    std::string key;   ///< where its name would stand: "volume[0].name"
    std::string name;  ///< as the scene says; empty: it says nothing
    std::string fallback;
};

/// "fire" of "shots/fire_0045.vdb": a name stays the same in all frames.
std::string nameOfFile(const std::filesystem::path& file, const std::string& ifNothingIsLeft) {
    // All digits of a pattern, so that they are left out.
    std::string name = std::filesystem::path(withFrame(file.string(), 1000)).stem().string();
    const std::size_t last = name.find_last_not_of("0123456789");
    const std::size_t first = last == std::string::npos ? 0 : last + 1,
                      digits = name.size() - first;
    const auto separates = [&](std::size_t i) { return std::string("._-").find(name[i]) < 3; };
    constexpr std::size_t fewestDigits = 3;  // "cloud2" is another cloud
    if (digits >= fewestDigits || (digits > 0 && first > 0 && separates(first - 1))) {
        name.resize(first);
        while (!name.empty() && separates(name.size() - 1)) name.pop_back();
    }
    return name.empty() ? ifNothingIsLeft : name;
}

struct NameOfShape {
    std::string operator()(const MeshShape& mesh) const { return nameOfFile(mesh.file, "mesh"); }
    std::string operator()(const SphereShape&) const { return "sphere"; }
    std::string operator()(const BoxShape&) const { return "box"; }
    std::string operator()(const DiskShape&) const { return "disk"; }
    std::string operator()(const PlaneShape&) const { return "plane"; }
    std::string operator()(const LatheShape&) const { return "lathe"; }
    std::string operator()(const FacetShape&) const { return "facets"; }
};

std::vector<Named> objectsOf(const SceneDescription& scene) {
    std::vector<Named> all;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const VolumeDescription& v = scene.volumes[i];
        all.push_back({fmt::format("volume[{}].name", i), v.name,
                       v.file.empty() ? "medium" : nameOfFile(v.file, "volume")});
    }
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        const SurfaceDescription& s = scene.surfaces[i];
        all.push_back(
            {fmt::format("surface[{}].name", i), s.name, std::visit(NameOfShape(), s.shape)});
    }
    return all;
}

/// Gives every thing a name of its own; `names` are those of the layer so far.
class Namer {
public:
    Namer(const SceneDescription& scene, const std::string& kind) : scene_(scene), kind_(kind) {}

    /// The number of a name that the scene says.
    std::uint32_t take(const std::string& key, const std::string& name) {
        if (const auto taken = keys_.find(name); taken != keys_.end())
            throw error(key,
                        "is '{}', which is the name of {} already. A matte by {} cannot tell "
                        "them apart",
                        name, taken->second, kind_);
        return add(key, name);
    }
    /// The number of a name like `wanted`.
    std::uint32_t choose(const std::string& key, const std::string& wanted,
                         std::vector<std::string>* notes) {
        std::string name = wanted;
        for (int i = 2; keys_.contains(name); ++i) name = fmt::format("{}_{}", wanted, i);
        if (notes) notes->push_back(fmt::format("{} = \"{}\"", key, name));
        return add(key, name);
    }
    std::vector<std::string> names() && { return std::move(names_); }

private:
    template <class... A>
    Error error(const std::string& key, fmt::format_string<A...> text, A&&... args) const {
        const std::string place = findPlace(scene_.places, key);
        return inputError("{}{}{} {}", place, place.empty() ? "" : ": ", key,
                          fmt::format(text, std::forward<A>(args)...));
    }

    std::uint32_t add(const std::string& key, const std::string& name) {
        keys_.emplace(name, key);
        const auto [other, isNew] = ids_.emplace(image::matteBits(name), name);
        if (!isNew)
            throw error(key,
                        "is '{}', which Cryptomatte gives the same id {:08x} as '{}'. Give one "
                        "of them another name",
                        name, other->first, other->second);
        names_.push_back(name);
        return static_cast<std::uint32_t>(names_.size() - 1);
    }

    const SceneDescription& scene_;
    std::string kind_;
    std::vector<std::string> names_;
    std::map<std::string, std::string> keys_;  // by name
    std::map<std::uint32_t, std::string> ids_;
};

/// Names that the scene says come first, so that those that are chosen make way for them.
std::vector<std::uint32_t> nameAll(Namer& namer, const std::vector<Named>& things,
                                   std::vector<std::string>* notes) {
    std::vector<std::uint32_t> numbers(things.size());
    for (std::size_t i = 0; i < things.size(); ++i)
        if (!things[i].name.empty()) numbers[i] = namer.take(things[i].key, things[i].name);
    for (std::size_t i = 0; i < things.size(); ++i)
        if (things[i].name.empty())
            numbers[i] = namer.choose(things[i].key, things[i].fallback, notes);
    return numbers;
}

image::MatteLayer objectLayer(const SceneDescription& scene, std::vector<std::string>* notes) {
    Namer namer(scene, "object");
    std::vector<std::uint32_t> numbers = nameAll(namer, objectsOf(scene), notes);
    return {"CryptoObject", std::move(namer).names(), std::move(numbers)};
}

image::MatteLayer materialLayer(const SceneDescription& scene, std::vector<std::string>* notes) {
    Namer namer(scene, "material");
    std::map<std::string, std::uint32_t> materials;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        materials[scene.materials[i].name] =
            namer.take(fmt::format("material[{}].name", i), scene.materials[i].name);
    std::vector<Named> volumes = objectsOf(scene);
    volumes.resize(scene.volumes.size());
    std::vector<std::uint32_t> numbers = nameAll(namer, volumes, notes);
    for (const SurfaceDescription& surface : scene.surfaces) {
        if (surface.material.empty() && !materials.contains(""))
            materials[""] =
                namer.choose("the material of surfaces that name none", "default", notes);
        numbers.push_back(materials.at(surface.material));
    }
    return {"CryptoMaterial", std::move(namer).names(), std::move(numbers)};
}

}  // namespace

std::vector<image::MatteLayer> matteLayers(const SceneDescription& scene,
                                           const std::vector<std::string>& kinds,
                                           std::vector<std::string>* notes) {
    std::vector<image::MatteLayer> layers;
    for (const std::string& kind : kinds) {
        if (kind == "object")
            layers.push_back(objectLayer(scene, notes));
        else if (kind == "material")
            layers.push_back(materialLayer(scene, notes));
        else
            throw usageError("unknown matte '{}'{}", kind,
                             suggestName(kind, "known mattes", image::matteKinds()));
    }
    return layers;
}

}  // namespace woodcock::scene
