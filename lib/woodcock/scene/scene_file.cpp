// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "woodcock/base/regular_file.h"
#include "woodcock/scene/animation.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/light_groups.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/quality.h"

namespace woodcock::scene {
namespace {

// ---- reading

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

void checkOrbit(const SceneDescription& scene) {
    if (!scene.camera.orbit) return;
    for (const AnimatedValue& value : scene.animation)
        for (const char* key : {"eye", "look_at", "up", "matrix"})
            if (value.table == "camera" && value.key == key)
                throw inputError(
                    "{}: camera.orbit cannot be used together with keys of camera.{}; turn the "
                    "keys instead",
                    findPlace(scene.places, "camera.orbit"), key);
}

/// The scene at frame 0. All others are read at every key, to find mistakes there.
SceneDescription readAnimated(toml::table& table, const std::string& name,
                              const std::filesystem::path& base, const Places& places) {
    const auto read = [&] {
        SceneDescription scene = readScene(TomlTable(table, ""), name, base);
        scene.places = places;
        checkSurfaces(scene);
        return scene;
    };
    AnimatedTree tree(table);
    if (tree.empty()) return read();
    for (const double frame : tree.frames()) {
        tree.setFrame(frame);
        read();
    }
    tree.setFrame(0);
    SceneDescription scene = read();
    scene.animation = tree.valuesOf(scene);
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

// ---- writing

void write(SceneWriter& out, const VolumeDescription& volume) {
    out.heading("[[volume]]");
    writeKeys(out, volume);
}

void write(SceneWriter& out, const MaterialDescription& material) {
    out.heading("[[material]]");
    writeKeys(out, material);
    writeTagged(out, material.material);
}

void write(SceneWriter& out, const SurfaceDescription& surface) {
    out.heading("[[surface]]");
    writeKeys(out, surface);
}

void write(SceneWriter& out, const LightDescription& light) {
    out.heading("[[light]]");
    writeTagged(out, light.light);
    writeKeys(out, light);
}

void write(SceneWriter& out, const CameraDescription& camera) {
    out.heading("[camera]");
    writeKeys(out, camera);
}

void write(SceneWriter& out, const OutputDescription& output) {
    out.heading("[output]");
    writeKeys(out, output);
}

/// What moves within the shutter, for a digest.
void writeAnimation(SceneWriter& out, const SceneDescription& scene) {
    if (scene.animation.empty()) return;
    out.heading("[animation]");
    out.line("frame", tomlNumber(scene.frame));
    for (const AnimatedValue& value : scene.animation)
        out.line(value.table + "." + value.key, value.value);
}

/// A section, with what of it is animated.
template <class Section>
void write(SceneWriter& out, const Section& section, const SceneDescription& scene,
           const std::string& table) {
    if (out.isDigest() || !isAnimated(scene, table)) return write(out, section);
    SceneWriter own = out.empty();
    write(own, section);
    out.append(withAnimation(own.text(), scene, table));
}

template <class Section>
void writeList(SceneWriter& out, const std::vector<Section>& list, const SceneDescription& scene,
               const std::string& name) {
    for (std::size_t i = 0; i < list.size(); ++i)
        write(out, list[i], scene, fmt::format("{}[{}]", name, i));
}

void write(SceneWriter& out, const SceneDescription& scene) {
    out.comment("A Woodcock scene. Lengths are world units, angles degrees, colours scene-linear.");
    writeKeys(out, scene);
    writeList(out, scene.volumes, scene, "volume");
    writeList(out, scene.materials, scene, "material");
    writeList(out, scene.surfaces, scene, "surface");
    writeList(out, scene.lights, scene, "light");
    if (scene.camera != CameraDescription() || isAnimated(scene, "camera"))
        write(out, scene.camera, scene, "camera");
    out.heading("[render]");
    writeKeys(out, scene.render);
    if (out.isDigest()) {
        writeAnimation(out, scene);
    } else if (scene.output != OutputDescription() || isAnimated(scene, "output")) {
        write(out, scene.output, scene, "output");
    }
}

/// FNV-1a, 64 bits.
std::uint64_t hashOf(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3;
    }
    return hash;
}

template <class Section>
std::string writeSection(const Section& section) {
    SceneWriter out(".", SceneWriter::Mode::File);
    write(out, section);
    return out.text();
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
        if (overriddenKey(assignment) == qualityPath()) eraseChoices(table);
        applyOverride(table, assignment);
    }
    keepOverriddenSuns(table);
    expandQuality(table);
    Places places;
    for (const auto& [key, value] : table) collectPlaces(value, std::string(key.str()), places);
    SceneDescription scene = readAnimated(table, name, baseDirectory, places);
    checkOrbit(scene);
    scene.lightChanges = std::move(lightChanges);
    checkLightChanges(scene);
    checkLightGroups(scene);
    return scene;
}

SceneDescription parseScene(const std::filesystem::path& file,
                            const std::vector<std::string>& overrides) {
    return parseSceneText(readTomlFile(file, "scene file"), file.string(), file.parent_path(),
                          overrides);
}

std::string writeVolume(const VolumeDescription& volume) { return writeSection(volume); }
std::string writeCamera(const CameraDescription& camera) { return writeSection(camera); }
std::string writeLight(const LightDescription& light) { return writeSection(light); }
std::string writeMaterial(const MaterialDescription& material) { return writeSection(material); }
std::string writeSurface(const SurfaceDescription& surface) { return writeSection(surface); }
std::string writeOutput(const OutputDescription& output) { return writeSection(output); }

std::string writeScene(const SceneDescription& scene, const std::filesystem::path& directory) {
    SceneWriter out(directory, SceneWriter::Mode::File);
    write(out, scene);
    return out.text();
}

std::string sceneDigest(const SceneDescription& scene) {
    SceneDescription content = scene;
    // However it is said where a sun stands.
    for (LightDescription& light : content.lights) {
        if (auto* sun = std::get_if<SunDescription>(&light.light)) sun->place.reset();
        if (auto* sky = std::get_if<SkyDescription>(&light.light)) sky->moment.reset();
    }
    SceneWriter out(".", SceneWriter::Mode::Digest);
    write(out, content);
    return fmt::format("{:016x}", hashOf(out.text()));
}

std::string filesDigest(const SceneDescription& scene) {
    constexpr std::size_t most = 1 << 16;
    SceneDescription content = scene;
    std::string text;
    std::error_code ignored;
    for (const std::filesystem::path* path : sceneFiles(content)) {
        // What is read once, such as a pipe, cannot be looked at.
        if (path->empty() || !std::filesystem::is_regular_file(*path, ignored)) continue;
        const RegularFile file(*path, "file");
        text += fmt::format("{} ", file.size());
        text += file.read(0, most);
        text += file.read(file.size() - std::min<std::uint64_t>(file.size(), most), most);
    }
    return fmt::format("{:016x}", hashOf(text));
}

std::vector<std::filesystem::path*> sceneFiles(SceneDescription& scene) {
    Files files;
    const auto addKind = [&](auto& kind) { addFiles(kind, files); };
    for (VolumeDescription& volume : scene.volumes) addFiles(volume, files);
    for (LightDescription& light : scene.lights) std::visit(addKind, light.light);
    for (MaterialDescription& material : scene.materials) std::visit(addKind, material.material);
    for (SurfaceDescription& surface : scene.surfaces) addFiles(surface, files);
    return files;
}

}  // namespace woodcock::scene
