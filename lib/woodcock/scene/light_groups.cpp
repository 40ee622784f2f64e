// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/light_groups.h"

#include <algorithm>

#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/overrides.h"

namespace woodcock::scene {
namespace {

/// Calls visit(value, group) for all that may name a group; `value`: "light[0].group".
template <class Visit>
void forEachGroup(const SceneDescription& scene, Visit visit) {
    for (size_t i = 0; i < scene.volumes.size(); ++i)
        visit(fmt::format("volume[{}].group", i), scene.volumes[i].group);
    for (size_t i = 0; i < scene.materials.size(); ++i)
        if (const auto* m = std::get_if<EmissiveDescription>(&scene.materials[i].material))
            visit(fmt::format("material[{}].group", i), m->group);
    for (size_t i = 0; i < scene.surfaces.size(); ++i)
        if (const auto& interior = scene.surfaces[i].interior)
            visit(fmt::format("surface[{}].medium.group", i), interior->group);
    const std::vector<LightDescription> lights =
        scene.lightChanges.empty() ? scene.lights : foreseenLights(scene);
    for (size_t i = 0; i < lights.size(); ++i)
        visit(fmt::format("light[{}].group", i), lights[i].group);
}

Error error(const SceneDescription& scene, const std::string& value, const std::string& message) {
    const std::string place = findPlace(scene.places, value);
    return inputError("{}{}{} {}", place, place.empty() ? "" : ": ", value, message);
}

/// Nuke takes `-` in the name of a layer for `_`.
bool alikeInNuke(std::string a, std::string b) {
    std::replace(a.begin(), a.end(), '-', '_');
    std::replace(b.begin(), b.end(), '-', '_');
    return a == b;
}

/// The groups of what emits in a mix.
std::vector<std::string> groupsOfMix(const SceneDescription& scene, const MixDescription& mix) {
    std::vector<std::string> groups;
    for (const std::string& name : {mix.first, mix.second}) {
        const auto part = findNamed(scene.materials, name);
        if (!part) continue;
        if (const auto* m = std::get_if<EmissiveDescription>(&scene.materials[*part].material))
            groups.push_back(m->group);
    }
    return groups;
}

}  // namespace

std::vector<std::string> lightGroups(const SceneDescription& scene) {
    std::vector<std::string> groups;
    forEachGroup(scene, [&](const std::string&, const std::string& group) {
        if (!group.empty() && std::find(groups.begin(), groups.end(), group) == groups.end())
            groups.push_back(group);
    });
    return groups;
}

std::uint8_t groupNumber(std::span<const std::string> groups, const std::string& name) {
    const auto found = std::find(groups.begin(), groups.end(), name);
    return found == groups.end() ? 0 : static_cast<std::uint8_t>(found - groups.begin() + 1);
}

std::string groupOfMaterial(const SceneDescription& scene, const MaterialDescription& material) {
    if (const auto* emissive = std::get_if<EmissiveDescription>(&material.material))
        return emissive->group;
    if (const auto* mix = std::get_if<MixDescription>(&material.material))
        if (const std::vector<std::string> groups = groupsOfMix(scene, *mix); !groups.empty())
            return groups.front();
    return "";
}

image::LayerList outputLayers(const SceneDescription& scene) {
    image::LayerList layers =
        image::layersFromNames(scene.output.layers, lightGroups(scene), scene.output.half);
    if (scene.render.denoise == Denoise::Always) image::dropLayersOfNoise(layers);
    return layers;
}

image::LayerNeeds layerNeeds(const SceneDescription& scene) {
    image::LayerNeeds needs = image::needsOf(outputLayers(scene), lightGroups(scene));
    needs.features |= scene.render.denoise == Denoise::Always;
    return needs;
}

void checkLightGroups(const SceneDescription& scene) {
    std::vector<std::string> known;
    forEachGroup(scene, [&](const std::string& value, const std::string& group) {
        if (group.empty() || std::find(known.begin(), known.end(), group) != known.end()) return;
        if (known.size() == image::mostLightGroups)
            throw error(scene, value,
                        fmt::format("is '{}', but there are {} light groups already, and no more "
                                    "can be told apart; give several lights one group",
                                    group, known.size()));
        for (const std::string& other : known)
            if (alikeInNuke(group, other))
                throw error(scene, value,
                            fmt::format("is '{}', and there is a group '{}': Nuke takes - for _, "
                                        "and makes one layer of both; rename one of them",
                                        group, other));
        known.push_back(group);
    });
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const auto* mix = std::get_if<MixDescription>(&scene.materials[i].material);
        if (!mix) continue;
        const std::vector<std::string> groups = groupsOfMix(scene, *mix);
        const auto word = [](const std::string& group) {
            return group.empty() ? "none" : "'" + group + "'";
        };
        if (groups.size() == 2 && groups[0] != groups[1])
            throw error(scene, fmt::format("material[{}]", i),
                        fmt::format("mixes light of two groups, {} and {}; a surface counts to "
                                    "one, so give both the same, or make two surfaces",
                                    word(groups[0]), word(groups[1])));
    }
    try {
        outputLayers(scene);
    } catch (const Error& e) {
        throw error(scene, "output.layers", fmt::format("is wrong: {}", e.what()));
    }
}

}  // namespace woodcock::scene
