// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/report.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "woodcock/base/parse.h"

namespace woodcock::tool {

void reportBake(const bake::Bake& bake) {
    constexpr const char* sides[]{"-x", "+x", "-y", "+y", "-z", "+z"};
    for (const bake::BakedGridStatistics& grid : bake.statistics) {
        spdlog::info(
            "{}: {} active voxels ({:.2g} % of the box) in {} leaves and {} tiles, {}, values {:g} "
            "to {:g}",
            grid.name, grid.activeVoxels,
            100 * static_cast<double>(grid.activeVoxels) / bake.boxVoxels, grid.leaves, grid.tiles,
            fmt::format("{:.1f} MB", static_cast<double>(grid.bytes) / 1e6), grid.least,
            grid.greatest);
        if (grid.activeVoxels == 0) spdlog::warn("{} is empty", grid.name);
        std::string cut;
        for (std::size_t i = 0; i < 6; ++i)
            if (grid.atBounds[i])
                cut += fmt::format("{}{} ({} voxels)", cut.empty() ? "" : ", ", sides[i],
                                   grid.atBounds[i]);
        if (!cut.empty())
            spdlog::warn("{} reaches the recipe's bounds, which may cut it off: {}", grid.name,
                         cut);
    }
    const double seconds = std::max(bake.seconds, 1e-9);
    spdlog::info("evaluated {} voxels in {}: {:.3g} million a second; the box has {:.4g}",
                 bake.evaluatedVoxels, formatDuration(bake.seconds),
                 static_cast<double>(bake.evaluatedVoxels) / seconds / 1e6, bake.boxVoxels);
}

nlohmann::ordered_json bakeJson(const bake::Recipe& recipe, const bake::Bake& bake,
                                const BakeFrame& frame,
                                const std::vector<std::filesystem::path>& files) {
    using Json = nlohmann::ordered_json;
    Json json = Json::object();
    if (frame.number) json["frame"] = *frame.number;
    json["recipe"] = recipe.name;
    for (const bake::Parameter& p : recipe.parameters.all()) json["parameters"][p.name] = p.value;
    for (const std::filesystem::path& file : files) {
        std::error_code unknown;
        const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
        json["files"].push_back(
            {{"file", file.string()}, {"bytes", unknown ? Json() : Json(bytes)}});
    }
    for (const bake::BakedGridStatistics& grid : bake.statistics)
        json["grids"].push_back({{"name", grid.name},
                                 {"active_voxels", grid.activeVoxels},
                                 {"leaves", grid.leaves},
                                 {"tiles", grid.tiles},
                                 {"bytes", grid.bytes},
                                 {"least", grid.least},
                                 {"greatest", grid.greatest}});
    json["box_voxels"] = bake.boxVoxels;
    json["evaluated_voxels"] = bake.evaluatedVoxels;
    json["seconds"] = bake.seconds;
    return json;
}

}  // namespace woodcock::tool
