// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/overrides.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <variant>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/toml_nesting.h"
#include "woodcock/base/toml_reader.h"
#include "woodcock/base/toml_text.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::scene {
namespace {

/// A key of a table, or an index into an array.
using Step = std::variant<std::string, size_t>;

bool isKeyLetter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
}

/// "volume[0].scale" -> volume, 0, scale; empty where it is not written so.
std::vector<Step> parseSteps(std::string_view path) {
    std::vector<Step> steps;
    size_t i = 0;
    while (i < path.size()) {
        if (path[i] == '[') {
            size_t index = 0;
            const char* const end = path.data() + path.size();
            const auto [stop, failed] = std::from_chars(path.data() + i + 1, end, index);
            if (failed != std::errc() || stop == end || *stop != ']' || steps.empty()) return {};
            steps.emplace_back(index);
            i = static_cast<size_t>(stop - path.data()) + 1;
        } else {
            if (!steps.empty() && path[i++] != '.') return {};
            const size_t begin = i;
            while (i < path.size() && isKeyLetter(path[i])) ++i;
            if (i == begin) return {};
            steps.emplace_back(std::string(path.substr(begin, i - begin)));
        }
    }
    return steps;
}

/// The table {key = value}, its values placed at `place`.
toml::table parseAssignment(const std::string& key, const std::string& value,
                            const std::string& place) {
    if (value.find_first_of("\r\n") == std::string::npos) {
        try {
            return toml::parse(key + " = " + value, place);
        } catch (const toml::parse_error&) {
            // No TOML: a bare word.
        }
    }
    try {
        return toml::parse(key + " = " + tomlText(value), place);
    } catch (const toml::parse_error& e) {
        throw inputError("{}: {}", place, e.description());
    }
}

/// One override on its way down the scene.
class Override {
public:
    explicit Override(const std::string& text) : place_(std::string(overrideMark) + shown(text)) {
        const size_t equals = text.find('=');
        steps_ = parseSteps(overriddenKey(text));
        if (equals == std::string::npos || steps_.empty())
            throw usageError("{}: expected KEY=VALUE, such as volume[0].scale=2", place_);
        if (steps_.size() > mostKeyParts)
            throw inputError("{}: the key has more than {} parts; no key that is known has so many",
                             place_, mostKeyParts);
        value_ = text.substr(equals + 1);
        refuseDeepKeys(value_, place_);
    }

    void apply(toml::table& scene) const {
        toml::node* node = &scene;
        std::string name;
        for (size_t i = 0; i < steps_.size(); ++i) {
            const bool last = i + 1 == steps_.size();
            if (const auto* key = std::get_if<std::string>(&steps_[i])) {
                toml::table& table = asTable(*node, name, *key);
                toml::node* const next = table.get(*key);
                if (last || !next) return insert(table, i);
                node = next;
                name += (name.empty() ? "" : ".") + *key;
            } else {
                const size_t index = std::get<size_t>(steps_[i]);
                toml::array& array = asArray(*node, name, index);
                if (last) return replace(array, index);
                node = array.get(index);
                name += fmt::format("[{}]", index);
            }
        }
    }

private:
    toml::table& asTable(toml::node& node, const std::string& name, const std::string& key) const {
        if (toml::table* table = node.as_table()) return *table;
        if (node.is_array())
            throw inputError("{}: {} is a list; say which, as in {}[0].{}", place_, name, name,
                             key);
        throw inputError("{}: {} is a single value and has no key '{}'", place_, name, key);
    }

    toml::array& asArray(toml::node& node, const std::string& name, size_t index) const {
        toml::array* const array = node.as_array();
        if (!array) throw inputError("{}: {} is not a list", place_, name);
        if (index >= array->size()) throw missing(name, array->size());
        return *array;
    }

    /// `name` is a list too short for the index that was asked for.
    Error missing(const std::string& name, size_t size) const {
        const bool section =
            std::find(sceneLists.begin(), sceneLists.end(), name) != sceneLists.end();
        if (!section) return inputError("{}: {} has {} elements", place_, name, size);
        if (size == 0)
            return inputError(
                "{}: the scene has no {}{}", place_, name,
                name == "light" ? " of its own; --write-scene saves the chosen ones" : "");
        if (size == 1) return inputError("{}: the scene has 1 {}, {}[0]", place_, name, name);
        return inputError("{}: the scene has {} {}s, {}[0] to {}[{}]", place_, size, name, name,
                          name, size - 1);
    }

    /// Sets what steps_[first] and the keys after it lead to, in `table`.
    void insert(toml::table& table, size_t first) const {
        std::string keys;
        for (size_t i = first; i < steps_.size(); ++i) {
            const auto* key = std::get_if<std::string>(&steps_[i]);
            if (!key) throw missing(std::get<std::string>(steps_[i - 1]), 0);
            keys += (keys.empty() ? "" : ".") + *key;
        }
        toml::table parsed = parseAssignment(keys, value_, place_);
        const toml::key key = parsed.begin()->first;
        // Moved, never copied: a copy of a node forgets its place.
        std::move(*parsed.get(key)).visit([&](auto&& node) {
            table.erase(key);  // or the old key would keep its place in the file
            table.insert(key, std::move(node));
        });
        // Each says how a medium scatters: what is set takes the other's place.
        if (key == "phase") table.erase("g");
        if (key == "g" && table.contains("phase")) table.erase("phase");
        // An image says what is above and below.
        if (key == "image")
            for (const char* end : {"above", "below"}) table.erase(end);
    }

    void replace(toml::array& array, size_t index) const {
        toml::table parsed = parseAssignment("value", value_, place_);
        std::move(*parsed.get("value")).visit([&](auto&& node) {
            array.replace(array.begin() + static_cast<std::ptrdiff_t>(index), std::move(node));
        });
    }

    std::string place_, value_;
    std::vector<Step> steps_;
};

}  // namespace

void applyOverride(toml::table& scene, const std::string& text) { Override(text).apply(scene); }

std::string overriddenKey(const std::string& text) {
    std::string path = text.substr(0, text.find('='));
    std::erase(path, ' ');
    return path;
}

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
    EnvironmentDescription fill;
    fill.visible = false;
    return changedLights({{sun}, {EnvironmentDescription()}, {fill}}, scene.lightChanges);
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
