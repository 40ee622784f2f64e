// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/bake/node.h"
#include "woodcock/bake/recipe.h"
#include "woodcock/base/toml_reader.h"

namespace woodcock::bake {

class ParameterSet;

/// Reads one node's table of a recipe. Numbers may be expressions of the recipe's parameters. Every
/// key that is read counts as known; finish() refuses the others.
class NodeReader {
public:
    /// Adds the input of a key to the graph (a node's name, a number, or a table that is a node
    /// itself), and returns its entry.
    using AddInput = std::function<int(const TomlValue&)>;

    NodeReader(TomlTable table, const ParameterSet& parameters, const RecipeText& source,
               const Graph& graph, AddInput add)
        : table_(std::move(table)),
          parameters_(&parameters),
          source_(&source),
          graph_(&graph),
          add_(std::move(add)) {}

    const TomlTable& table() const { return table_; }
    bool has(std::string_view key);
    double number(std::string_view key, double otherwise, NumberRange range = {});
    double number(std::string_view key, NumberRange range = {});  ///< needed
    Vec3d vector(std::string_view key, Vec3d otherwise);
    Vec3d vector(std::string_view key);  ///< needed
    /// From one number, for all axes, or three.
    Vec3d extent(std::string_view key, std::optional<double> otherwise, NumberRange range);
    int integer(std::string_view key, int otherwise, int lower, int upper);
    std::uint64_t seed();  ///< of the recipe's seed and the node's own `seed`
    std::string text(std::string_view key, std::string_view example);
    std::size_t choice(std::string_view key, std::span<const std::string> known,
                       std::size_t otherwise);
    std::filesystem::path file(std::string_view key = "file");  ///< that of the frame
    std::vector<TomlValue> list(std::string_view key, std::string_view expected);
    double numberOf(const TomlValue& value, NumberRange range = {}) const;
    Vec3d vectorOf(const TomlValue& value) const;

    /// Adds an input, with as many channels (0: any), and returns how many it has.
    int input(std::string_view key, int channels = 1);
    int inputs(std::string_view key);  ///< a list of at least one; returns the most channels
    /// A table of inputs of any kind, if there is one: their names and numbers of channels.
    std::vector<std::pair<std::string, int>> namedInputs(std::string_view key);
    /// The entry that a mapping moves.
    int mapped(std::string_view key);

    std::string placeOf(std::string_view key) { return need(key).place(); }
    std::vector<int> takeInputs() { return std::move(inputs_); }
    const std::vector<std::filesystem::path>& files() const { return files_; }  ///< asked for
    void finish() const;

private:
    TomlValue need(std::string_view key);
    std::optional<TomlValue> find(std::string_view key);
    int addInput(const TomlValue& value, int channels);

    TomlTable table_;
    const ParameterSet* parameters_;
    const RecipeText* source_;
    const Graph* graph_;
    AddInput add_;
    std::vector<std::string> known_{"type"};
    std::vector<int> inputs_;
    std::vector<std::filesystem::path> files_;
};

/// Makes the node that the table's `type` names. Errors: Input, with the place in the recipe.
Graph::Entry makeNode(NodeReader& reader);

std::vector<std::string> nodeTypes();  ///< all that makeNode knows, sorted

// The functions that make nodes, one for each type; makeNode() calls them. Each file of nodes
// offers its own list.
struct NodeType {
    const char* name;
    Graph::Entry (*make)(NodeReader&);
};
std::span<const NodeType> shapeNodes();
std::span<const NodeType> noiseNodes();
std::span<const NodeType> combinationNodes();
std::span<const NodeType> mappingNodes();
std::span<const NodeType> puffNodes();
std::span<const NodeType> gridNodes();
std::span<const NodeType> axNodes();

}  // namespace woodcock::bake
