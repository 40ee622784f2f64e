// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/parse.h"

#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/quality.h"

namespace woodcock::scene {
namespace {

/// The tables of a list such as [[volume]]; none where the key is missing.
std::vector<TomlTable> tablesOf(const TomlTable& scene, const std::string& key) {
    std::vector<TomlTable> tables;
    const auto list = scene.find(key);
    if (!list) return tables;
    if (list->isTable())
        throw list->error(
            "is a single table; write [[{}]] in double brackets, as there can be "
            "several",
            key);
    for (const TomlValue& element : list->elements(fmt::format("a list of [[{}]] tables", key)))
        tables.push_back(element.table());
    return tables;
}

void collectPlaces(const toml::node& node, const std::string& name, Places& places) {
    places[name] = placeOf(node.source());
    if (const toml::table* table = node.as_table())
        for (const auto& [key, value] : *table)
            collectPlaces(value, name + "." + std::string(key.str()), places);
    if (const toml::array* array = node.as_array())
        for (size_t i = 0; i < array->size(); ++i)
            collectPlaces(*array->get(i), fmt::format("{}[{}]", name, i), places);
}

SceneDescription readScene(const TomlTable& table, const std::string& name,
                           const std::filesystem::path& base) {
    SceneDescription scene;
    std::vector<std::string> sections(sceneLists.begin(), sceneLists.end());
    sections.insert(sections.end(), {"camera", "render", "output"});
    readKeys(table, scene, base, sections);
    for (const TomlTable& volume : tablesOf(table, "volume"))
        scene.volumes.push_back(readVolume(volume, base));
    for (const TomlTable& material : tablesOf(table, "material"))
        scene.materials.push_back(readMaterial(material, base));
    for (const TomlTable& surface : tablesOf(table, "surface"))
        scene.surfaces.push_back(readSurface(surface, base));
    if (scene.volumes.empty() && scene.surfaces.empty())
        throw inputError(
            "{}: the scene has no [[volume]] and no [[surface]]; the least is\n"
            "[[volume]]\nfile = \"smoke.vdb\"",
            name);
    scene.lights = readLights(table, base);
    if (const auto render = table.find("render")) readKeys(render->table(), scene.render, base);
    const double aspect = double(scene.render.width) / scene.render.height;
    if (const auto camera = table.find("camera"))
        scene.camera = readCamera(camera->table(), aspect);
    if (const auto output = table.find("output")) readKeys(output->table(), scene.output, base);
    return scene;
}

/// Tries overrides of lights that are still to be chosen on placeholders, to find mistakes in them.
void checkLightChanges(const SceneDescription& scene) {
    if (scene.lightChanges.empty()) return;
    if (anySurfaceEmits(scene))
        throw inputError(
            "{}{}: the scene has no [[light]], and none is chosen where a surface emits light",
            overrideMark, scene.lightChanges.front());
    foreseenLights(scene);
}

}  // namespace

std::vector<LightDescription> readLights(const TomlTable& scene,
                                         const std::filesystem::path& base) {
    std::vector<LightDescription> lights;
    for (const TomlTable& light : tablesOf(scene, "light"))
        lights.push_back(readLight(light, base));
    return lights;
}

SceneDescription parseSceneText(std::string_view text, const std::string& name,
                                const std::filesystem::path& baseDirectory,
                                const std::vector<std::string>& overrides) {
    toml::table table = parseToml(text, name);
    std::vector<std::string> lightChanges;
    for (const std::string& assignment : overrides) {
        if (changesALight(assignment) && !table.contains("light")) {
            lightChanges.push_back(assignment);
            continue;
        }
        if (overriddenKey(assignment) == "render.quality") eraseChoices(table);
        applyOverride(table, assignment);
    }
    keepOverriddenSuns(table);
    expandQuality(table);
    SceneDescription scene = readScene(TomlTable(table, ""), name, baseDirectory);
    for (const auto& [key, value] : table)
        collectPlaces(value, std::string(key.str()), scene.places);
    checkSurfaces(scene);
    scene.lightChanges = std::move(lightChanges);
    checkLightChanges(scene);
    return scene;
}

SceneDescription parseScene(const std::filesystem::path& file,
                            const std::vector<std::string>& overrides) {
    return parseSceneText(readTomlFile(file, "scene file"), file.string(), file.parent_path(),
                          overrides);
}

}  // namespace woodcock::scene
