// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/parse.h"

#include <fstream>
#include <sstream>

#include "woodcock/scene/overrides.h"
#include "woodcock/scene/parse_sections.h"

namespace woodcock {
namespace {

constexpr std::uintmax_t largestFile = 4 << 20;

toml::table parseToml(std::string_view text, const std::string& name) {
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& e) {
        throw inputError("{}: {}", placeOf(e.source()), e.description());
    }
}

std::string readSceneFile(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
        throw inputError("scene file '{}' does not exist", file.string());
    if (std::filesystem::is_directory(status))
        throw inputError("scene file '{}' is a directory", file.string());
    if (std::filesystem::is_regular_file(status) &&
        std::filesystem::file_size(file, error) > largestFile)
        throw inputError("scene file '{}' is larger than {} MB: is it a scene file?", file.string(),
                         largestFile >> 20);
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream) throw inputError("scene file '{}' cannot be read", file.string());
    return text.str();
}

/// The tables of a list such as [[volume]]; none where the key is missing.
std::vector<SceneTable> tablesOf(const SceneTable& scene, const std::string& key) {
    std::vector<SceneTable> tables;
    const auto list = scene.find(key);
    if (!list) return tables;
    if (list->isTable())
        throw list->error(
            "is a single table; write [[{}]] in double brackets, as there can be "
            "several",
            key);
    for (const SceneValue& element : list->elements(fmt::format("a list of [[{}]] tables", key)))
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

SceneDescription readScene(const SceneTable& table, const std::string& name,
                           const std::filesystem::path& base) {
    table.allowOnly({"volume", "light", "camera", "render", "output", "ocio"}, "the scene");
    SceneDescription scene;
    for (const SceneTable& volume : tablesOf(table, "volume"))
        scene.volumes.push_back(parseVolume(volume, base));
    if (scene.volumes.empty())
        throw inputError(
            "{}: the scene has no [[volume]]; the least is\n"
            "[[volume]]\nfile = \"smoke.vdb\"",
            name);
    for (const SceneTable& light : tablesOf(table, "light"))
        scene.lights.push_back(parseLight(light, base));
    if (const auto render = table.find("render")) scene.render = parseRender(render->table());
    const double aspect = double(scene.render.width) / scene.render.height;
    if (const auto camera = table.find("camera"))
        scene.camera = parseCamera(camera->table(), aspect);
    if (const auto output = table.find("output")) scene.output = parseOutput(output->table(), base);
    if (const auto ocio = table.find("ocio")) scene.ocio = ocio->path(base);
    return scene;
}

}  // namespace

SceneDescription parseSceneText(std::string_view text, const std::string& name,
                                const std::filesystem::path& baseDirectory,
                                const std::vector<std::string>& overrides) {
    toml::table table = parseToml(text, name);
    for (const std::string& assignment : overrides) applyOverride(table, assignment);
    SceneDescription scene = readScene(SceneTable(table, ""), name, baseDirectory);
    for (const auto& [key, value] : table)
        collectPlaces(value, std::string(key.str()), scene.places);
    return scene;
}

SceneDescription parseScene(const std::filesystem::path& file,
                            const std::vector<std::string>& overrides) {
    return parseSceneText(readSceneFile(file), file.string(), file.parent_path(), overrides);
}

}  // namespace woodcock
