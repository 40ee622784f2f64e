// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/quality.h"

#include <algorithm>

#include "woodcock/base/toml_reader.h"
#include "woodcock/scene/keys/sections.h"

namespace woodcock::scene {
namespace {

const std::string& renderSection() { return keysOf<RenderDescription>().path; }

const std::string& volumeStorage() {
    static const VolumeDescription volume;
    return keyName(volume, volume.storage);
}

/// Keys of which one at most has a meaning: where one is written, a quality does not bring the
/// other.
std::vector<std::pair<std::string, std::string>> alternatives() {
    const RenderDescription r;
    const render::Approximations& a = r.approximations;
    const auto name = [&](const auto& member) { return keyName(r, member); };
    return {{name(a.octaves), name(a.similarityAfter)},
            {name(a.similarityAfter), name(a.octaves)},
            {name(a.jackknife), name(a.marchStep)}};
}

bool isDisplaced(const toml::table& render, std::string_view key) {
    if (render.contains(key)) return true;
    static const auto pairs = alternatives();
    return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
        return pair.first == key && render.contains(pair.second);
    });
}

template <class Wanted>
std::vector<std::string> renderKeys(Wanted wanted) {
    std::vector<std::string> names;
    for (const Key<RenderDescription>& key : keysOf<RenderDescription>().keys)
        if (wanted(key.info)) names.push_back(key.info.name);
    return names;
}

}  // namespace

const std::vector<RenderChoice>& qualityChoices(Quality quality) {
    static const std::array<std::vector<RenderChoice>, 4> choices{
        {{{"similarity_after", "1"},
          {"level_of_detail", "1"},
          {"storage", "\"half\""},
          {"transparent_shadows", "true"},
          {"adaptive", "true"}},
         {{"similarity_after", "2"},
          {"storage", "\"half\""},
          {"transparent_shadows", "true"},
          {"adaptive", "true"},
          {"denoise", "\"if_installed\""}},
         {{"adaptive", "true"}},
         {{"storage", "\"float\""}, {"adaptive", "false"}}}};
    return choices[static_cast<std::size_t>(quality)];
}

std::string qualityPath() { return fmt::format("{}.{}", renderSection(), qualityKey); }

std::vector<std::string> choiceKeys() {
    return renderKeys([](const KeyInfo& key) { return key.choice; });
}

std::vector<std::string> methodKeys() {
    return renderKeys([](const KeyInfo& key) { return key.method; });
}

bool isReducedPrecision(grid::Storage storage) {
    return storage != grid::Storage::Auto && storage != grid::Storage::Float;
}

void eraseChoices(toml::table& scene) {
    if (toml::table* render = scene[renderSection()].as_table())
        for (const std::string& key : choiceKeys()) render->erase(key);
    if (toml::array* volumes = scene["volume"].as_array())
        for (toml::node& volume : *volumes)
            if (toml::table* table = volume.as_table()) table->erase(volumeStorage());
}

void expandQuality(toml::table& scene) {
    toml::table* const render = scene[renderSection()].as_table();
    const toml::node* const node = render ? render->get(qualityKey) : nullptr;
    if (!node) return;
    const TomlValue name(*node, qualityPath());
    const auto quality = static_cast<Quality>(name.choice(qualityKey, qualityNames));
    const std::string place = fmt::format("{}, {}", name.place(), qualityKey);
    std::vector<const RenderChoice*> missing;  // found first: what is added displaces nothing
    for (const RenderChoice& choice : qualityChoices(quality))
        if (!isDisplaced(*render, choice.key)) missing.push_back(&choice);
    for (const RenderChoice* choice : missing) {
        toml::table added = toml::parse(choice->key + " = " + choice->value, place);
        std::move(*added.get(choice->key)).visit([&](auto&& value) {
            render->insert(choice->key, std::move(value));
        });
    }
}

std::vector<std::string> biasedChoices(const SceneDescription& scene) {
    std::vector<std::string> keys;
    for (const Key<RenderDescription>& key : keysOf<RenderDescription>().keys)
        if (key.biased && key.biased(scene.render))
            keys.push_back(renderSection() + "." + key.info.name);
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (isReducedPrecision(scene.volumes[i].storage))
            keys.push_back(fmt::format("volume[{}].{}", i, volumeStorage()));
    return keys;
}

}  // namespace woodcock::scene
