// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/recipe.h"

#include <algorithm>
#include <set>

#include "woodcock/bake/node_reader.h"
#include "woodcock/bake/pointwise.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/printable.h"
#include "woodcock/base/toml_text.h"

namespace woodcock::bake {

namespace {

class RecipeBuilder {
public:
    RecipeBuilder(const RecipeText& source, const std::vector<ParameterSetting>& settings)
        : source_(source),
          toml_(parseToml(source.text, source.name)),
          table_(toml_, ""),
          settings_(settings) {
        table_.allowOnly({"about", "parameters", "let", "bounds", "node", "output", "preview"},
                         "the recipe");
    }

    std::string about() const {
        const auto about = table_.find("about");
        return about ? about->text() : "";
    }

    ParameterSet parameters() const {
        ParameterSet set;
        const auto given = table_.find("parameters");
        const auto declare = [&](const std::string& name, const char* standard) {
            if (given && given->table().has(name)) return;
            const toml::table own = toml::parse(standard);
            set.declare(name, TomlTable(own, "").need(name, ""));
        };
        declare("seed",
                "seed = { default = 1, integer = true, about = \"of all that is random\" }");
        declare("time", "time = { default = 0, about = \"seconds\" }");
        if (given)
            for (const std::string& name : given->table().keys())
                set.declare(name, *given->table().find(name));
        for (const ParameterSetting& s : settings_) set.set(s.name, s.value, s.origin);
        if (const auto let = table_.find("let")) set.derive(let->table());
        return set;
    }

    Recipe build() {
        Recipe recipe;
        recipe.name = source_.name, recipe.about = about();
        recipe.parameters = parameters();
        recipe_ = &recipe;
        readBounds();
        const auto nodes = table_.find("node");
        if (nodes) nodes_ = nodes->table();
        readOutputs();
        readPreview();
        for (const std::string& name : nodeNames())
            if (!entryOf_.contains(name))
                entryOf_[name] = addNode(*nodes_->find(name));  // unused, yet checked
        return recipe;
    }

private:
    std::vector<std::string> nodeNames() const {
        return nodes_ ? nodes_->keys() : std::vector<std::string>();
    }

    Vec3d vectorOf(const TomlValue& value) const {
        const auto e = value.elements("[x, y, z]", 3);
        const auto number = [&](const TomlValue& v) { return recipe_->parameters.evaluate(v); };
        return {number(e[0]), number(e[1]), number(e[2])};
    }

    void readBounds() {
        const TomlTable bounds =
            table_.need("bounds", "bounds = { min = [-1, -1, -1], max = [1, 1, 1] }").table();
        bounds.allowOnly({"min", "max"}, "the bounds");
        const TomlValue low = bounds.need("min", "min = [-1, -1, -1]"),
                        high = bounds.need("max", "max = [1, 1, 1]");
        recipe_->bounds = {vectorOf(low), vectorOf(high)};
        recipe_->boundsPlace = low.place();
        for (int i = 0; i < 3; ++i)
            if (!(recipe_->bounds.lower[i] <= recipe_->bounds.upper[i]))
                throw high.error("lies below min along {}: {} < {}", "xyz"[i],
                                 recipe_ -> bounds.upper[i], recipe_->bounds.lower[i]);
    }

    /// The text, with each $(expression) replaced by its value.
    std::string fillIn(const TomlValue& text) const {
        const std::string source = text.text();
        std::string filled;
        for (std::size_t i = 0; i < source.size();) {
            const std::size_t start = source.find("$(", i);
            filled += source.substr(i, start - i);
            if (start == std::string::npos) break;
            std::size_t end = start + 1;
            for (int open = 0; end < source.size(); ++end) {
                open += source[end] == '(' ? 1 : source[end] == ')' ? -1 : 0;
                if (open == 0) break;
            }
            if (end == source.size()) throw text.error("has a $( without a closing )");
            toml::table expression;
            expression.insert("expression", source.substr(start + 2, end - start - 2));
            try {
                filled += tomlNumber(
                    recipe_->parameters.evaluate(TomlTable(expression, "").need("expression", "")));
            } catch (const Error& e) {
                throw text.error("has {}", e.what());
            }
            i = end + 1;
        }
        return filled;
    }

    void readPreview() {
        const auto preview = table_.find("preview");
        if (!preview) return;
        const TomlTable table = preview->table();
        table.allowOnly({"scene"}, "the preview");
        const TomlValue scene = table.need("scene", "scene = \"\"\" ... \"\"\"");
        recipe_->preview = fillIn(scene);
        recipe_->previewPlace = scene.place();
        if (recipe_->preview.find(previewVolume) == std::string::npos)
            throw scene.error("shows no volume; it needs a [[volume]] with file = \"{}\"",
                              previewVolume);
    }

    void readOutputs() {
        const auto outputs = table_.find("output");
        if (!outputs)
            throw inputError(
                "{}: the recipe has no [[output]]; add at least\n[[output]]\nname = "
                "\"density\"\nnode = \"the name of a node\"",
                source_.name);
        std::vector<std::pair<std::size_t, TomlValue>> masks;
        for (const TomlValue& element : outputs->elements("a list of [[output]] tables")) {
            const TomlTable table = element.table();
            table.allowOnly({"name", "node", "tolerance", "mask"}, "an output");
            RecipeOutput output;
            const TomlValue name = table.need("name", "name = \"density\"");
            output.name = name.text();
            output.place = table.place();
            for (const RecipeOutput& other : recipe_->outputs)
                if (other.name == output.name) throw name.error("is used by another output");
            output.entry = addValue(table.need("node", "node = \"a node's name\""));
            output.channels =
                recipe_->graph.entries[static_cast<std::size_t>(output.entry)].channels;
            if (const auto tolerance = table.find("tolerance")) {
                output.tolerance = recipe_->parameters.evaluate(*tolerance);
                if (output.tolerance < 0) throw tolerance->error("must not be negative");
            }
            if (const auto mask = table.find("mask"))
                masks.emplace_back(recipe_->outputs.size(), *mask);
            recipe_->outputs.push_back(output);
        }
        if (recipe_->outputs.empty()) throw outputs->error("is empty");
        for (const auto& [index, mask] : masks) readMask(index, mask);
    }

    void readMask(std::size_t index, const TomlValue& mask) {
        std::vector<std::string> known;
        for (const RecipeOutput& output : recipe_->outputs)
            if (output.name != recipe_->outputs[index].name) known.push_back(output.name);
        const std::string wanted = mask.text();
        for (std::size_t i = 0; i < recipe_->outputs.size(); ++i)
            if (recipe_->outputs[i].name == wanted && i != index)
                recipe_->outputs[index].mask = static_cast<int>(i);
        if (!recipe_->outputs[index].mask)
            throw mask.error("is not another output: '{}'{}", shown(wanted),
                             suggestName(wanted, "outputs", known));
        const auto target = static_cast<std::size_t>(*recipe_->outputs[index].mask);
        if (recipe_->outputs[target].mask)
            throw mask.error("names an output that has a mask of its own");
    }

    /// The entry of a value: a number, a node's name, or a table that is a node.
    int addValue(const TomlValue& value) {
        if (value.isTable()) return addNode(value);
        if (!value.isText()) {
            const double v = value.number();
            Graph::Entry entry;
            entry.node = pointwise(
                1, [v](std::span<const double>) { return v; },
                [v](std::span<const Interval>) { return Interval::of(v); });
            return addEntry(std::move(entry));
        }
        const std::string name = value.text();
        const auto node = nodes_ ? nodes_->find(name) : std::nullopt;
        if (!node)
            throw value.error("is not a node: '{}'{}", shown(name),
                              suggestName(name, "nodes", nodeNames()));
        if (const auto known = entryOf_.find(name); known != entryOf_.end()) return known->second;
        for (std::size_t i = 0; i < open_.size(); ++i)
            if (open_[i] == name) {
                std::string circle;
                for (; i < open_.size(); ++i) circle += shown(open_[i]) + " -> ";
                throw value.error("refers to itself: {}{}", circle, shown(name));
            }
        open_.push_back(name);
        const int entry = addNode(*node);
        open_.pop_back();
        return entryOf_[name] = entry;
    }

    int addNode(const TomlValue& value) {
        if (!value.isTable()) throw value.error("is not a node; expected a table with a type");
        NodeReader reader(value.table(), recipe_->parameters, source_, recipe_->graph,
                          [this](const TomlValue& input) { return addValue(input); });
        if (++depth_ > deepest) throw value.error("is nested more than {} nodes deep", deepest);
        Graph::Entry entry = makeNode(reader);
        --depth_;
        recipe_->files.insert(recipe_->files.end(), reader.files().begin(), reader.files().end());
        if (entry.mapping)
            entry.channels =
                recipe_->graph.entries[static_cast<std::size_t>(entry.mapped)].channels;
        return addEntry(std::move(entry));
    }

    int addEntry(Graph::Entry entry) {
        recipe_->graph.entries.push_back(std::move(entry));
        return static_cast<int>(recipe_->graph.entries.size()) - 1;
    }

    static constexpr int deepest = 500;  ///< nodes within nodes: each takes some of the stack

    const RecipeText& source_;
    toml::table toml_;
    TomlTable table_;
    const std::vector<ParameterSetting>& settings_;
    std::optional<TomlTable> nodes_;
    Recipe* recipe_ = nullptr;
    std::map<std::string, int> entryOf_;
    int depth_ = 0;                  ///< of the node that is being made
    std::vector<std::string> open_;  ///< names of the nodes that are being made
};

}  // namespace

RecipeText readRecipe(const std::filesystem::path& file) {
    return {readTomlFile(file, "recipe"), file.string(), file.parent_path()};
}

ParameterSet recipeParameters(const RecipeText& text, const std::vector<ParameterSetting>& set) {
    return RecipeBuilder(text, set).parameters();
}

std::string recipeAbout(const RecipeText& text) { return RecipeBuilder(text, {}).about(); }

Recipe makeRecipe(const RecipeText& text, const std::vector<ParameterSetting>& set) {
    return RecipeBuilder(text, set).build();
}

}  // namespace woodcock::bake
