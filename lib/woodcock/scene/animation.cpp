// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <set>

#include "woodcock/base/toml_text.h"
#include "woodcock/scene/animation_curve.h"
#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::scene {

void refuseMotion(const TomlValue& value, const KeyInfo& info,
                  const std::function<std::vector<std::string>()>& movingNames,
                  const TomlTable& table) {
    if (value.isAtFrame() ? info.moves : !value.isArray()) return;
    if (value.isAtFrame()) {
        const std::vector<std::string> names = movingNames();
        throw value.error("cannot be animated; {}",
                          names.empty() ? "nothing of this table can"
                                        : fmt::format("of {}, these can: {}", table.name(),
                                                      fmt::join(names, ", ")));
    }
    for (const TomlValue& element : value.elements("a list")) {
        if (!element.isTable() && element.isAtFrame())
            throw element.error("cannot be animated by itself{}",
                                info.moves ? fmt::format("; animate all of {}", value.name()) : "");
        refuseMotion(element, info, movingNames, table);
    }
}

namespace {

// ---- sections

/// What is known of a section's keys.
struct SectionKeys {
    std::vector<Exclusion> exclusions;
    std::set<std::string> unwritten;  ///< keys that say what others are written for
};

template <class D>
void addKeys(const D& d, SectionKeys& section) {
    const KeyTable<D>& table = keysOf<D>();
    section.exclusions.insert(section.exclusions.end(), table.exclusions.begin(),
                              table.exclusions.end());
    const SceneWriter out(".", SceneWriter::Mode::File);
    for (const Key<D>& key : table.keys) {
        if (!belongs(key, d)) continue;
        if (!key.write || (key.info.moves && !key.write(d, out)))
            section.unwritten.insert(key.info.name);
        else if (key.write(d, out))
            section.unwritten.erase(key.info.name);
    }
}

/// A section of a scene: "volume[2]", "camera".
struct SectionName {
    std::string list;  ///< or its name, where there is one
    std::size_t index = 0;

    explicit SectionName(std::string_view table) {
        const std::size_t bracket = table.find('[');
        list = table.substr(0, bracket);
        if (bracket != std::string_view::npos)
            std::from_chars(table.data() + bracket + 1, table.data() + table.size(), index);
    }
};

SectionKeys keysOfSection(const SceneDescription& scene, std::string_view table) {
    const SectionName name(table);
    SectionKeys section;
    const auto add = [&](const auto& d) { addKeys(d, section); };
    if (name.list == "volume") add(scene.volumes.at(name.index));
    if (name.list == "surface") add(scene.surfaces.at(name.index));
    if (name.list == "light") std::visit(add, scene.lights.at(name.index).light);
    if (name.list == "material") {
        add(scene.materials.at(name.index));
        std::visit(add, scene.materials.at(name.index).material);
    }
    if (name.list == "camera") add(scene.camera);
    if (name.list == "output") add(scene.output);
    return section;
}

std::string writeSection(const SceneDescription& scene, const SectionName& name) {
    if (name.list == "volume") return writeVolume(scene.volumes.at(name.index));
    if (name.list == "surface") return writeSurface(scene.surfaces.at(name.index));
    if (name.list == "light") return writeLight(scene.lights.at(name.index));
    if (name.list == "material") return writeMaterial(scene.materials.at(name.index));
    if (name.list == "camera") return writeCamera(scene.camera);
    return writeOutput(scene.output);
}

/// The section in a file that holds it alone.
toml::table& sectionOf(toml::table& file) {
    toml::node& node = file.begin()->second;
    return node.is_array() ? *node.as_array()->get(0)->as_table() : *node.as_table();
}

void readSection(SceneDescription& scene, const SectionName& name, const TomlTable& table) {
    if (name.list == "volume") scene.volumes.at(name.index) = readVolume(table, {});
    if (name.list == "surface") scene.surfaces.at(name.index) = readSurface(table, {});
    if (name.list == "light") scene.lights.at(name.index) = readLight(table, {});
    if (name.list == "material") scene.materials.at(name.index) = readMaterial(table, {});
    if (name.list == "camera")
        scene.camera = readCamera(table, double(scene.render.width) / scene.render.height);
    if (name.list == "output") {
        scene.output = {};
        readKeys(table, scene.output, {});
    }
}

// ---- values in their places

/// Puts the value of a node that was just parsed into a table. Moved, never copied: a copy of a
/// node forgets its place.
void put(toml::table& table, const std::string& key, toml::node& value) {
    std::move(value).visit([&](auto&& node) {
        table.erase(key);
        table.insert(key, std::move(node));
    });
}

toml::table parseValue(const std::string& value, const std::string& place) {
    return toml::parse("v = " + value, place);
}

std::string placeAtFrame(const std::string& place, double frame) {
    return fmt::format("{}{}{}", place, frameMark, frame);
}

/// Calls found(parent table or null, parent array or null, key, index, name) for all curves below.
template <class F>
void forEachCurve(toml::node& node, const std::string& name, F&& found) {
    if (toml::table* table = node.as_table()) {
        for (auto&& [key, child] : *table) {
            const std::string path =
                fmt::format("{}{}{}", name, name.empty() ? "" : ".", std::string(key.str()));
            if (ValueCurve::is(child))
                found(table, nullptr, std::string(key.str()), std::size_t{0}, path, child);
            else
                forEachCurve(child, path, found);
        }
    } else if (toml::array* array = node.as_array()) {
        for (std::size_t i = 0; i < array->size(); ++i) {
            const std::string path = fmt::format("{}[{}]", name, i);
            if (ValueCurve::is(*array->get(i)))
                found(nullptr, array, std::string(), i, path, *array->get(i));
            else
                forEachCurve(*array->get(i), path, found);
        }
    }
}

/// The text of a value with all its curves at a frame.
std::string textAt(const std::string& value, double frame) {
    toml::table parsed = parseValue(value, "");
    std::vector<std::function<void()>> changes;  // once the walk is over
    forEachCurve(parsed, "",
                 [&](toml::table* table, toml::array* array, const std::string& key,
                     std::size_t index, const std::string& name, toml::node& node) {
                     const std::string text = ValueCurve(TomlValue(node, name)).at(frame);
                     changes.emplace_back([=] {
                         toml::table at = parseValue(text, "");
                         if (table) return put(*table, key, *at.get("v"));
                         std::move(*at.get("v")).visit([&](auto&& v) {
                             array->replace(array->begin() + static_cast<std::ptrdiff_t>(index),
                                            std::move(v));
                         });
                     });
                 });
    for (const auto& change : changes) change();
    return tomlOf(*parsed.get("v"));
}

/// Sets "colour.times" of a section, and leaves out what says the same in another way.
void setValue(toml::table& section, const std::string& key, const std::string& value,
              const std::string& place, const SectionKeys& keys) {
    toml::table* table = &section;
    std::string rest = key;
    for (std::size_t dot; (dot = rest.find('.')) != std::string::npos; rest.erase(0, dot + 1))
        if (toml::table* inner = (*table)[rest.substr(0, dot)].as_table()) table = inner;
    if (table == &section)
        for (const Exclusion& e : keys.exclusions) {
            if (e.key == key) table->erase(e.other);
            if (e.other == key) table->erase(e.key);
        }
    toml::table parsed = parseValue(value, place);
    put(*table, rest, *parsed.get("v"));
}

std::set<std::string> tablesOf(const SceneDescription& scene) {
    std::set<std::string> tables;
    for (const AnimatedValue& value : scene.animation) tables.insert(value.table);
    return tables;
}

}  // namespace

SceneDescription atFrame(const SceneDescription& scene, double frame) {
    SceneDescription there = scene;
    there.frame = frame;
    for (const std::string& table : tablesOf(scene)) {
        const SectionName name(table);
        const SectionKeys keys = keysOfSection(scene, table);
        // Not by placeAtFrame(): what can be animated was found out when the scene was read, and
        // values that only stand beside such a one cannot.
        const std::string place = fmt::format("at frame {}", frame);
        toml::table file = toml::parse(writeSection(scene, name), place);
        toml::table& section = sectionOf(file);
        for (const AnimatedValue& value : scene.animation) {
            if (value.table != table) continue;
            const std::string written = findPlace(scene.places, table + "." + value.key);
            setValue(section, value.key, textAt(value.value, frame),
                     written.empty() ? place : fmt::format("{}, {}", place, written), keys);
        }
        readSection(there, name, TomlTable(section, table));
    }
    if (!scene.animation.empty()) checkSurfaces(there);
    return there;
}

std::vector<double> keyFrames(const SceneDescription& scene) {
    std::set<double> frames;
    for (const AnimatedValue& value : scene.animation) {
        toml::table parsed = parseValue(value.value, "");
        forEachCurve(parsed, "",
                     [&](const auto&, const auto&, const auto&, std::size_t,
                         const std::string& name, toml::node& node) {
                         const ValueCurve curve(TomlValue(node, name));
                         frames.insert(curve.frames().begin(), curve.frames().end());
                     });
    }
    return {frames.begin(), frames.end()};
}

bool isAnimated(const SceneDescription& scene, std::string_view table) {
    return std::any_of(scene.animation.begin(), scene.animation.end(),
                       [&](const AnimatedValue& value) { return value.table == table; });
}

std::string withAnimation(const std::string& section, const SceneDescription& scene,
                          std::string_view table) {
    if (!isAnimated(scene, table)) return section;
    const SectionKeys keys = keysOfSection(scene, table);
    std::set<std::string> replaced;
    std::string lines;
    for (const AnimatedValue& value : scene.animation) {
        if (value.table != table) continue;
        const std::string outer = value.key.substr(0, value.key.find('.'));
        replaced.insert(outer);
        for (const Exclusion& e : keys.exclusions) {
            if (e.key == outer) replaced.insert(e.other);
            if (e.other == outer) replaced.insert(e.key);
        }
    }
    // The values of this section, each written once, with all of its curves.
    toml::table file = toml::parse(section);
    std::set<std::string> written;
    for (const AnimatedValue& value : scene.animation) {
        if (value.table != table) continue;
        const std::string outer = value.key.substr(0, value.key.find('.'));
        setValue(sectionOf(file), value.key, value.value, "", keys);
        written.insert(outer);
    }
    for (const std::string& key : written)
        lines += fmt::format("{} = {}\n", key, tomlOf(*sectionOf(file).get(key)));
    // All other lines as they are. Values that take several lines end at a line of their own.
    std::string kept;
    bool skips = false;
    for (std::size_t begin = 0; begin < section.size();) {
        const std::size_t end = std::min(section.find('\n', begin), section.size() - 1) + 1;
        const std::string line = section.substr(begin, end - begin);
        begin = end;
        const bool starts = line[0] != ' ' && line[0] != ']';
        if (starts) skips = replaced.contains(line.substr(0, line.find(' ')));
        if (!skips) kept += line;
    }
    return kept + lines;
}

// ---- reading

struct AnimatedTree::Curve {
    toml::table* table;
    toml::array* array;
    std::string key;
    std::size_t index;
    std::string name;  ///< "volume[0].transform.rotate"
    ValueCurve curve;
};

/// As it was written.
struct AnimatedTree::Section {
    std::string table;
    std::map<std::string, std::string> values;  ///< TOML of its keys
};

AnimatedTree::~AnimatedTree() = default;

AnimatedTree::AnimatedTree(toml::table& root) {
    forEachCurve(
        root, "",
        [&](toml::table* table, toml::array* array, const std::string& key, std::size_t index,
            const std::string& name, toml::node& node) {
            const std::string section = name.substr(0, name.find('.'));
            static const std::set<std::string> known{"volume",   "surface", "light",
                                                     "material", "camera",  "output"};
            const TomlValue value(node, name);
            if (section == name || !known.contains(SectionName(section).list))
                throw value.error(
                    "cannot be animated; what can stands in [[volume]], [[surface]], [[material]], "
                    "[[light]], [camera] and [output]");
            curves_.push_back({table, array, key, index, name, ValueCurve(value)});
            if (!sections_.empty() && sections_.back().table == section) return;
            Section& added = sections_.emplace_back(Section{section, {}});
            const SectionName path(section);
            toml::node& list = *root.get(path.list);
            const toml::table& all =
                list.is_array() ? *list.as_array()->get(path.index)->as_table() : *list.as_table();
            for (const auto& [k, v] : all) added.values[std::string(k.str())] = tomlOf(v);
        });
}

std::vector<double> AnimatedTree::frames() const {
    std::set<double> frames;
    for (const Curve& curve : curves_)
        frames.insert(curve.curve.frames().begin(), curve.curve.frames().end());
    return {frames.begin(), frames.end()};
}

void AnimatedTree::setFrame(double frame) {
    for (const Curve& c : curves_) {
        toml::table parsed =
            parseValue(c.curve.at(frame), placeAtFrame(c.curve.placeAt(frame), frame));
        if (c.table)
            put(*c.table, c.key, *parsed.get("v"));
        else
            std::move(*parsed.get("v")).visit([&](auto&& node) {
                c.array->replace(c.array->begin() + static_cast<std::ptrdiff_t>(c.index),
                                 std::move(node));
            });
    }
}

std::vector<AnimatedValue> AnimatedTree::valuesOf(const SceneDescription& scene) const {
    std::vector<AnimatedValue> values;
    for (const Section& section : sections_) {
        const SectionName name(section.table);
        toml::table file = toml::parse(writeSection(scene, name));
        std::set<std::string> taken;
        for (const Curve& c : curves_) {
            if (c.name.substr(0, c.name.find('.')) != section.table) continue;
            const std::string path = c.name.substr(section.table.size() + 1);
            const std::string outer = path.substr(0, path.find_first_of(".["));
            // A number in a table that is written as it was read keeps its place in there, and the
            // rest, with its files' names, is the description's. Else all of the key is kept.
            const bool inner =
                c.table && path != outer &&
                sectionOf(file).at_path(path.substr(0, path.rfind('.'))).is_table() &&
                section.values.at(outer).find('"') != std::string::npos;
            if (inner) {
                toml::table raw = toml::parse(outer + " = " + section.values.at(outer));
                values.push_back({section.table, path, tomlOf(*raw.at_path(path).node())});
            } else if (taken.insert(outer).second) {
                values.push_back({section.table, outer, section.values.at(outer)});
            }
        }
        // What stands beside, and is not written: the sensor of a focal length.
        for (const std::string& key : keysOfSection(scene, section.table).unwritten)
            if (section.values.contains(key) && !taken.contains(key))
                values.push_back({section.table, key, section.values.at(key)});
    }
    return values;
}

}  // namespace woodcock::scene
