// SPDX-License-Identifier: Apache-2.0
#include "woodcock/mesh/mesh_formats.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/base/regular_file.h"

namespace woodcock::mesh {

namespace {

constexpr std::size_t deepest = 200;

std::string jsonOf(const RegularFile& file) {
    constexpr std::size_t header = 20;  // of the file and of its first part
    const std::string head = file.read(0, header);
    if (!head.starts_with("glTF") || head.size() < header)
        return file.read(0, static_cast<std::size_t>(file.size()));
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, head.data() + 12, sizeof bytes);
    return file.read(header, bytes);
}

std::size_t nestingOf(const std::string& json) {
    std::size_t depth = 0, most = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (quoted && c == '\\')
            ++i;
        else if (c == '"')
            quoted = !quoted;
        else if (!quoted && (c == '[' || c == '{'))
            most = std::max(most, ++depth);
        else if (!quoted && (c == ']' || c == '}') && depth > 0)
            --depth;
    }
    return most;
}

/// Children of each node that there are.
std::vector<std::vector<std::size_t>> childrenIn(const nlohmann::json& scene) {
    std::vector<std::vector<std::size_t>> children;
    if (!scene.is_object() || !scene.contains("nodes") || !scene["nodes"].is_array())
        return children;
    for (const nlohmann::json& node : scene["nodes"]) {
        children.emplace_back();
        if (!node.is_object() || !node.contains("children")) continue;
        for (const nlohmann::json& child : node["children"])
            if (child.is_number_unsigned() && child.get<std::size_t>() < scene["nodes"].size())
                children.back().push_back(child.get<std::size_t>());
    }
    return children;
}

/// The longest chain of nodes; longer than the number of nodes where they form a circle.
std::size_t levelsOf(const std::vector<std::vector<std::size_t>>& children) {
    std::vector<std::size_t> parents(children.size()), level(children.size(), 1), ready;
    for (const auto& list : children)
        for (const std::size_t child : list) ++parents[child];
    for (std::size_t node = 0; node < children.size(); ++node)
        if (parents[node] == 0) ready.push_back(node);
    std::size_t most = 0, met = 0;
    for (; !ready.empty(); ++met) {
        const std::size_t node = ready.back();
        ready.pop_back();
        most = std::max(most, level[node]);
        for (const std::size_t child : children[node]) {
            level[child] = std::max(level[child], level[node] + 1);
            if (--parents[child] == 0) ready.push_back(child);
        }
    }
    return met < children.size() ? children.size() + 1 : most;
}

}  // namespace

void refuseDeepGltf(const std::filesystem::path& file) {
    const RegularFile open(file, "mesh");
    const std::string text = jsonOf(open);
    if (nestingOf(text) > deepest)
        throw open.unreadable(fmt::format("its JSON nests more than {} levels deep", deepest));
    const auto children = childrenIn(nlohmann::json::parse(text, nullptr, false));
    const std::size_t levels = levelsOf(children);
    if (levels > children.size()) throw open.unreadable("its nodes lead in a circle");
    if (levels > deepest)
        throw open.unreadable(
            fmt::format("its nodes follow each other more than {} levels deep", deepest));
}

}  // namespace woodcock::mesh
