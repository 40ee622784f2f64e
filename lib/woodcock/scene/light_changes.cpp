// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/light_changes.h"

#include "woodcock/base/toml_reader.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/write.h"

namespace woodcock::scene {

bool changesALight(const std::string& assignment) {
    return overriddenKey(assignment).starts_with("light[");
}

std::vector<LightDescription> changedLights(const std::vector<LightDescription>& lights,
                                            std::span<const std::string> overrides) {
    std::string text;
    for (const LightDescription& light : lights) text += writeLight(light);
    toml::table scene = parseToml(text, "the chosen lights");
    for (const std::string& assignment : overrides) applyOverride(scene, assignment);
    keepOverriddenSuns(scene);
    return readLights(TomlTable(scene, ""), "");
}

std::vector<LightDescription> foreseenLights(const SceneDescription& scene) {
    if (!scene.lights.empty()) return scene.lights;
    SunDescription sun;
    sun.angularDiameter = 0.53;
    sun.place = SunPlace{40, 0};
    return changedLights({{sun}, {EnvironmentDescription()}}, scene.lightChanges);
}

void keepOverriddenSuns(toml::table& scene) {
    toml::array* const lights = scene["light"].as_array();
    if (!lights) return;
    for (toml::node& node : *lights) {
        toml::table* const light = node.as_table();
        if (!light || !light->contains("direction")) continue;
        const auto overridden = [&](std::string_view key) {
            const toml::node* const value = light->get(key);
            return value && placeOf(value->source()).starts_with(overrideMark);
        };
        const bool angle = overridden("elevation") || overridden("azimuth") || overridden("up");
        if (overridden("direction") && !angle) {
            for (const char* key : {"elevation", "azimuth", "up"}) light->erase(key);
        } else if (overridden("elevation") && overridden("azimuth") && !overridden("direction")) {
            light->erase("direction");
        }
    }
}

}  // namespace woodcock::scene
