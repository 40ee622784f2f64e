// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/check_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/scene/keys/sections.h"

namespace woodcock::scene {
namespace {

/// The materials that a surface is made of: none for the default, one, or the two of a mixture.
std::vector<const MaterialDescription*> materialsOf(const SceneDescription& scene,
                                                    const std::string& name) {
    std::vector<const MaterialDescription*> found;
    const auto add = [&](const std::string& part) {
        if (const auto i = findNamed(scene.materials, part)) found.push_back(&scene.materials[*i]);
    };
    add(name);
    if (found.empty()) return found;
    if (const auto* mix = std::get_if<MixDescription>(&found[0]->material)) {
        found.clear();
        add(mix->first);
        add(mix->second);
    }
    return found;
}

template <class Kind>
bool is(const MaterialDescription& material) {
    return std::holds_alternative<Kind>(material.material);
}

bool holdsSomething(const SceneDescription& scene, const SurfaceDescription& surface) {
    return surface.interior ||
           std::any_of(scene.volumes.begin(), scene.volumes.end(), [&](const auto& volume) {
               return !volume.inside.empty() && volume.inside == surface.name;
           });
}

class Check {
public:
    explicit Check(const SceneDescription& scene) : scene_(scene) {}

    void all() const {
        repeatedNames(scene_.materials, "material");
        repeatedNames(scene_.surfaces, "surface");
        for (size_t i = 0; i < scene_.materials.size(); ++i)
            if (const auto* m = std::get_if<MixDescription>(&scene_.materials[i].material))
                mix(i, *m);
        for (size_t i = 0; i < scene_.surfaces.size(); ++i) surface(i);
        for (size_t i = 0; i < scene_.volumes.size(); ++i)
            if (!scene_.volumes[i].inside.empty()) filling(i);
    }

private:
    /// "place: value message".
    template <class... A>
    Error error(const std::string& value, fmt::format_string<A...> message, A&&... args) const {
        const std::string place = findPlace(scene_.places, value);
        return inputError("{}{}{} {}", place, place.empty() ? "" : ": ", value,
                          fmt::format(message, std::forward<A>(args)...));
    }

    template <class Named>
    size_t need(const std::vector<Named>& all, std::string_view kind, const std::string& value,
                const std::string& name) const {
        if (const auto found = findNamed(all, name)) return *found;
        std::vector<std::string> known;
        for (const Named& one : all)
            if (!one.name.empty()) known.push_back(one.name);
        throw error(value, "is '{}', but no {} has this name{}", name, kind,
                    suggestName(name, fmt::format("{}s", kind), known));
    }

    template <class Named>
    void repeatedNames(const std::vector<Named>& all, std::string_view kind) const {
        std::map<std::string, size_t> first;
        for (size_t i = 0; i < all.size(); ++i) {
            if (all[i].name.empty()) continue;
            const auto [known, isNew] = first.emplace(all[i].name, i);
            if (!isNew)
                throw error(fmt::format("{}[{}].name", kind, i),
                            "is '{}', which is the name of {}[{}] already", all[i].name, kind,
                            known->second);
        }
    }

    void mix(size_t index, const MixDescription& mix) const {
        const auto part = [&](const std::string& name) -> const auto& {
            const std::string value = fmt::format("material[{}].{}", index, keyName(mix, name));
            const auto& found = scene_.materials[need(scene_.materials, "material", value, name)];
            if (is<MixDescription>(found))
                throw error(value, "is '{}', a mix itself; a mix is of two other materials", name);
            return found;
        };
        const auto* first = std::get_if<DielectricDescription>(&part(mix.first).material);
        const auto* second = std::get_if<DielectricDescription>(&part(mix.second).material);
        if (first && second && first->ior != second->ior)
            throw error(fmt::format("material[{}]", index),
                        "mixes dielectrics of ior {} and {}, but what is inside has one",
                        first->ior, second->ior);
    }

    void surface(size_t index) const {
        const SurfaceDescription& surface = scene_.surfaces[index];
        const auto value = [&](const auto& member) {
            return fmt::format("surface[{}].{}", index, keyName(surface, member));
        };
        if (!surface.material.empty())
            need(scene_.materials, "material", value(surface.material), surface.material);
        const SurfaceNature nature = natureOf(scene_, index);
        if (!nature.letsLightIn && surface.interior)
            throw error(value(surface.interior), "can never be seen: {}", noWayIn(surface));
        const auto* plane = std::get_if<PlaneShape>(&surface.shape);
        const auto* disk = std::get_if<DiskShape>(&surface.shape);
        const bool infinite = plane && !plane->size;
        if (nature.encloses && (disk || (plane && !infinite)))
            throw error(plane ? value(*plane) : value(*disk),
                        "encloses nothing, so its material, '{}', cannot tell inside from outside; "
                        "give a closed shape, such as a thin box{}",
                        surface.material, plane ? ", or an infinite plane" : "");
        if (infinite && surface.interior) endlessGlow(index, *surface.interior);
        if (nature.emits && infinite)
            throw error(value(*plane),
                        "is infinite and would emit without end ('{}' is emissive); give it a size",
                        surface.material);
    }

    /// Below an infinite plane.
    void endlessGlow(size_t index, const InteriorDescription& interior) const {
        for (int c = 0; c < 3; ++c)
            if (interior.emission[c] > 0 && interior.sigmaA[c] == 0)
                throw error(fmt::format("surface[{}].medium.emission", index),
                            "would be infinitely bright: it fills all below a plane and absorbs "
                            "nothing in its {} channel; give it a sigma_a, or the plane a size",
                            std::array{"red", "green", "blue"}[static_cast<size_t>(c)]);
    }

    std::string noWayIn(const SurfaceDescription& surface) const {
        const auto i = findNamed(scene_.materials, surface.material);
        const std::string material =
            i ? fmt::format("'{}', of type {},", surface.material, typeName(scene_.materials[*i]))
              : std::string("the default material, diffuse,");
        return fmt::format("{} lets no light in; a dielectric or an interface does", material);
    }

    /// A volume inside of a surface.
    void filling(size_t index) const {
        const std::string value = fmt::format("volume[{}].inside", index);
        const std::string& name = scene_.volumes[index].inside;
        const size_t found = need(scene_.surfaces, "surface", value, name);
        const SurfaceDescription& surface = scene_.surfaces[found];
        if (!natureOf(scene_, found).letsLightIn)
            throw error(value, "is '{}', where it can never be seen: {}", name, noWayIn(surface));
        if (surface.instances.size() > 1)
            throw error(value,
                        "is '{}', which stands in {} places; a volume fills a surface that stands "
                        "in one",
                        name, surface.instances.size());
    }

    const SceneDescription& scene_;
};

}  // namespace

bool anySurfaceEmits(const SceneDescription& scene) {
    for (size_t i = 0; i < scene.surfaces.size(); ++i)
        if (natureOf(scene, i).emits) return true;
    return false;
}

SurfaceNature natureOf(const SceneDescription& scene, size_t index) {
    const SurfaceDescription& surface = scene.surfaces[index];
    const auto materials = materialsOf(scene, surface.material);
    SurfaceNature nature;
    bool dielectric = false, interface = false;
    for (const MaterialDescription* material : materials) {
        if (const auto* glass = std::get_if<DielectricDescription>(&material->material)) {
            dielectric = true;
            nature.ior = glass->ior;
        }
        interface |= is<InterfaceDescription>(*material);
        nature.emits |= is<EmissiveDescription>(*material);
    }
    nature.letsLightIn = dielectric || interface;
    const bool cutOut =
        interface && !dielectric && materials.size() == 2 &&
        !(is<InterfaceDescription>(*materials[0]) && is<InterfaceDescription>(*materials[1]));
    nature.encloses = nature.letsLightIn && (!cutOut || holdsSomething(scene, surface));
    return nature;
}

std::string_view typeName(const MaterialDescription& material) { return tagOf(material.material); }

void checkSurfaces(const SceneDescription& scene) { Check(scene).all(); }

}  // namespace woodcock::scene
