// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/node_reader.h"

#include <algorithm>
#include <cmath>

#include "woodcock/bake/parameters.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/random.h"

namespace woodcock::bake {

std::optional<TomlValue> NodeReader::find(std::string_view key) {
    known_.emplace_back(key);
    return table_.find(key);
}

bool NodeReader::has(std::string_view key) { return find(key).has_value(); }

TomlValue NodeReader::need(std::string_view key) {
    const auto value = find(key);
    if (!value) throw table_.error("has no {}", key);
    return *value;
}

double NodeReader::numberOf(const TomlValue& value, NumberRange range) const {
    const double v = parameters_->evaluate(value);
    if (!range.contains(v)) throw value.error("= {} {}", v, range.demand(v));
    return v;
}

Vec3d NodeReader::vectorOf(const TomlValue& value) const {
    const auto elements = value.elements("[x, y, z]", 3);
    return {numberOf(elements[0]), numberOf(elements[1]), numberOf(elements[2])};
}

double NodeReader::number(std::string_view key, double otherwise, NumberRange range) {
    const auto value = find(key);
    return value ? numberOf(*value, range) : otherwise;
}
double NodeReader::number(std::string_view key, NumberRange range) {
    return numberOf(need(key), range);
}

Vec3d NodeReader::vector(std::string_view key, Vec3d otherwise) {
    const auto value = find(key);
    return value ? vectorOf(*value) : otherwise;
}
Vec3d NodeReader::vector(std::string_view key) { return vectorOf(need(key)); }

Vec3d NodeReader::extent(std::string_view key, std::optional<double> otherwise, NumberRange range) {
    const auto value = otherwise ? find(key) : need(key);
    if (!value) return Vec3d{1, 1, 1} * *otherwise;
    if (!value->isArray()) return Vec3d{1, 1, 1} * numberOf(*value, range);
    const Vec3d v = vectorOf(*value);
    for (int i = 0; i < 3; ++i)
        if (!range.contains(v[i])) throw value->error("= {} {}", v[i], range.demand(v[i]));
    return v;
}

int NodeReader::integer(std::string_view key, int otherwise, int lower, int upper) {
    const auto value = find(key);
    if (!value) return otherwise;
    const double v = std::round(numberOf(*value));
    if (v < lower || v > upper)
        throw value->error("= {} must lie between {} and {}", v, lower, upper);
    return static_cast<int>(v);
}

std::uint64_t NodeReader::seed() {
    constexpr NumberRange whole{-0x1p53, 0x1p53};  // integers that a double holds exactly
    const double recipes = parameters_->at("seed"), own = number("seed", 0, whole);
    if (!whole.contains(recipes))
        throw table_.error("cannot use the recipe's seed, {}: it {}", recipes,
                           whole.demand(recipes));
    return hashOf(static_cast<std::uint64_t>(static_cast<std::int64_t>(recipes)),
                  static_cast<std::int64_t>(own));
}

std::string NodeReader::text(std::string_view key, std::string_view example) {
    find(key);
    return table_.need(key, example).text();
}

std::size_t NodeReader::choice(std::string_view key, std::span<const std::string> known,
                               std::size_t otherwise) {
    const auto value = find(key);
    return value ? value->choice(key, known) : otherwise;
}

std::filesystem::path NodeReader::file(std::string_view key) {
    std::filesystem::path file = need(key).path(source_->directory);
    if (source_->frame) file = withFrame(file.string(), *source_->frame);
    files_.push_back(std::move(file));
    return files_.back();
}

std::vector<TomlValue> NodeReader::list(std::string_view key, std::string_view expected) {
    return need(key).elements(expected);
}

int NodeReader::addInput(const TomlValue& value, int channels) {
    const int entry = add_(value);
    const int found = graph_->entries[static_cast<std::size_t>(entry)].channels;
    if (channels == 1 && found == 3)
        throw value.error("is a vector; expected a scalar, such as its length");
    if (channels == 3 && found == 1)
        throw value.error("is a scalar; expected a vector, such as curl noise");
    inputs_.push_back(entry);
    return found;
}

int NodeReader::input(std::string_view key, int channels) { return addInput(need(key), channels); }

int NodeReader::inputs(std::string_view key) {
    const TomlValue value = need(key);
    const auto elements = value.elements("a list of nodes");
    if (elements.empty()) throw value.error("is empty; expected a list of nodes");
    int most = 1;
    for (const TomlValue& element : elements) most = std::max(most, addInput(element, 0));
    return most;
}

std::vector<std::pair<std::string, int>> NodeReader::namedInputs(std::string_view key) {
    std::vector<std::pair<std::string, int>> inputs;
    const auto value = find(key);
    if (!value) return inputs;
    const TomlTable table = value->table();
    for (const std::string& name : table.keys())
        inputs.emplace_back(name, addInput(*table.find(name), 0));
    return inputs;
}

int NodeReader::mapped(std::string_view key) { return add_(need(key)); }

void NodeReader::finish() const {
    table_.allowOnly(known_, fmt::format("node '{}'", table_.find("type")->text()));
}

namespace {

std::vector<NodeType> allTypes() {
    std::vector<NodeType> all;
    for (const auto& some : {shapeNodes(), noiseNodes(), combinationNodes(), mappingNodes(),
                             puffNodes(), gridNodes(), axNodes()})
        all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end(), [](const NodeType& a, const NodeType& b) {
        return std::string_view(a.name) < b.name;
    });
    return all;
}

}  // namespace

std::vector<std::string> nodeTypes() {
    std::vector<std::string> names;
    for (const NodeType& type : allTypes()) names.emplace_back(type.name);
    return names;
}

Graph::Entry makeNode(NodeReader& reader) {
    static const std::vector<std::string> names = nodeTypes();
    static const std::vector<NodeType> types = allTypes();
    const std::size_t which =
        reader.table().need("type", "type = \"sphere\"").choice("node type", names);
    Graph::Entry entry = types[which].make(reader);
    reader.finish();
    entry.inputs = reader.takeInputs();
    entry.place = reader.table().place();
    if (entry.node) entry.channels = entry.node->channels();
    return entry;
}

}  // namespace woodcock::bake
