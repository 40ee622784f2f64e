// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/grid_roles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <span>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"

namespace woodcock::grid {

namespace {

std::string lowerCase(std::string_view text) {
    std::string s(text);
    std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return std::tolower(c); });
    return s;
}

/// In lower case, the likeliest first.
std::span<const std::string_view> namesOf(GridRole role) {
    static constexpr std::string_view density[]{"density", "smoke"};
    static constexpr std::string_view emission[]{"flame", "heat", "flames", "fuel", "burn"};
    static constexpr std::string_view temperature[]{"temperature"};
    static constexpr std::string_view colour[]{"cd", "color", "colour", "rgb", "albedo"};
    static constexpr std::string_view velocity[]{"vel", "v", "velocity"};
    switch (role) {
        case GridRole::Density:
            return density;
        case GridRole::Emission:
            return emission;
        case GridRole::Temperature:
            return temperature;
        case GridRole::Colour:
            return colour;
        case GridRole::Velocity:
            return velocity;
    }
    return {};
}

/// Scalars that are not a density, although they may be the only grid of a file.
bool meansSomethingElse(std::string_view name) {
    static constexpr std::string_view others[]{"shadow",     "collision", "collider", "pressure",
                                               "divergence", "surface",   "mask"};
    const std::string lower = lowerCase(name);
    if (std::find(std::begin(others), std::end(others), lower) != std::end(others)) return true;
    for (GridRole role :
         {GridRole::Emission, GridRole::Temperature, GridRole::Colour, GridRole::Velocity}) {
        const auto names = namesOf(role);
        if (std::find(names.begin(), names.end(), lower) != names.end()) return true;
    }
    return lower.starts_with("vel.") || lower.starts_with("velocity");
}

/// The first that matches; of several, the first that holds numbers.
template <class Match>
const GridListing* firstWhere(const VdbFile& file, Match match) {
    const GridListing* first = nullptr;
    for (const GridListing& grid : file.grids) {
        if (!match(grid)) continue;
        if (grid.channels > 0) return &grid;
        if (!first) first = &grid;
    }
    return first;
}

/// The finest of the levels of detail that OpenVDB's vdb_lod and Houdini's VDB LOD write for a grid
/// `name`: "name_level_0" at full resolution, "name_level_1" at half of it, "name_level_0.5"
/// between them. Null where there are none.
const GridListing* findFinestLevel(const VdbFile& file, std::string_view name) {
    const std::string begin = lowerCase(name) + "_level_";
    const GridListing* finest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const GridListing& grid : file.grids) {
        const std::string lower = lowerCase(grid.name);
        if (!lower.starts_with(begin) || grid.channels == 0) continue;
        const char* const end = lower.data() + lower.size();
        double level = 0;
        const auto [stop, error] = std::from_chars(lower.data() + begin.size(), end, level);
        if (error != std::errc() || stop != end || !(level < least)) continue;
        least = level;
        finest = &grid;
    }
    return finest;
}

std::string levelNote(const VdbFile& file, const GridListing& level, std::string_view name) {
    return fmt::format(
        "{} holds levels of detail of '{}'; took '{}', the finest of them; the others are coarser "
        "copies of it",
        file.path.string(), name, level.uniqueName);
}

/// The grid, with a note where the file holds others of the same name.
FoundGrid found(const VdbFile& file, const GridListing& grid, std::string note = {}) {
    const auto same = std::count_if(file.grids.begin(), file.grids.end(),
                                    [&](const GridListing& g) { return g.name == grid.name; });
    if (note.empty() && same > 1)
        note = fmt::format("{} holds {} grids named '{}'; took {}", file.path.string(), same,
                           grid.name, grid.uniqueName);
    return {grid, std::move(note)};
}

const GridListing* findByRoleName(const VdbFile& file, GridRole role) {
    for (std::string_view name : namesOf(role))
        if (const auto* grid =
                firstWhere(file, [&](const GridListing& g) { return lowerCase(g.name) == name; }))
            return grid;
    for (std::string_view name : namesOf(role))
        if (const auto* grid = findFinestLevel(file, name)) return grid;
    return nullptr;
}

/// Explains the number of a "name[2]", where the file has grids of that name.
std::string explainNumber(const VdbFile& file, std::string_view name) {
    const std::string_view base = name.substr(0, name.find('['));
    const bool known = base.size() < name.size() && name.ends_with(']') &&
                       firstWhere(file, [&](const GridListing& g) { return g.name == base; });
    return known ? "; [0], [1], ... number the grids of one name, in the file's order" : "";
}

}  // namespace

const char* roleName(GridRole role) {
    switch (role) {
        case GridRole::Density:
            return "density";
        case GridRole::Emission:
            return "emission";
        case GridRole::Temperature:
            return "temperature";
        case GridRole::Colour:
            return "colour";
        case GridRole::Velocity:
            return "velocity";
    }
    return "";
}

FoundGrid findGrid(const VdbFile& file, std::string_view name) {
    if (const auto* grid =
            firstWhere(file, [&](const GridListing& g) { return g.uniqueName == name; }))
        return {*grid, {}};
    if (const auto* grid = firstWhere(file, [&](const GridListing& g) { return g.name == name; }))
        return found(file, *grid);
    const std::string lower = lowerCase(name);
    if (const auto* grid = firstWhere(file, [&](const GridListing& g) {
            return lowerCase(g.uniqueName) == lower || lowerCase(g.name) == lower;
        }))
        return found(file, *grid,
                     fmt::format("'{}' is '{}' in {}", name, grid->uniqueName, file.path.string()));
    if (const auto* grid = findFinestLevel(file, name))
        return {*grid, levelNote(file, *grid, name)};

    std::vector<std::string> names;
    for (const GridListing& grid : file.grids) names.push_back(grid.uniqueName);
    const std::string near = nearestName(name, names);
    throw inputError("grid '{}' not found in {}{}; {}it has: {}", name, file.path.string(),
                     explainNumber(file, name), near.empty() ? "" : "did you mean '" + near + "'? ",
                     describeGrids(file));
}

FoundGrid findGrid(const VdbFile& file, GridRole role) {
    if (const auto* grid = findByRoleName(file, role)) {
        const std::size_t level = lowerCase(grid->name).find("_level_");
        return level == std::string::npos
                   ? found(file, *grid)
                   : FoundGrid{*grid, levelNote(file, *grid, grid->name.substr(0, level))};
    }
    if (role == GridRole::Density) {
        std::vector<const GridListing*> candidates;
        for (const GridListing& grid : file.grids)
            if (grid.usable() && grid.channels == 1 && !meansSomethingElse(grid.name))
                candidates.push_back(&grid);
        if (candidates.size() == 1) {
            const GridListing& only = *candidates.front();
            return {only, fmt::format("{} has no grid named density; took '{}', the only scalar "
                                      "grid that may be a density",
                                      file.path.string(), only.uniqueName)};
        }
    }
    std::string names;
    for (std::string_view name : namesOf(role))
        names += (names.empty() ? "" : ", ") + std::string(name);
    const bool points = std::any_of(file.grids.begin(), file.grids.end(),
                                    [](const auto& grid) { return grid.valueType == "points"; });
    throw inputError("no {} grid in {} (looked for: {}); it has: {}; name the grid to use{}",
                     roleName(role), file.path.string(), names, describeGrids(file),
                     points ? "; `woodcock convert IN OUT.vdb` makes a density of points" : "");
}

namespace {

constexpr std::array<std::string_view, 3> componentEndings{".", "_", ""};

/// The scalar grids that `base` and three endings name; none unless all three are there.
VelocityGrids threeComponents(const VdbFile& file, std::string_view base) {
    for (const std::string_view ending : componentEndings) {
        VelocityGrids grids;
        for (const char axis : {'x', 'y', 'z'}) {
            const std::string name = lowerCase(base) + std::string(ending) + axis;
            const auto* grid =
                firstWhere(file, [&](const GridListing& g) { return lowerCase(g.name) == name; });
            if (grid && grid->channels == 1) grids.push_back(*grid);
        }
        if (grids.size() == 3) return grids;
    }
    return {};
}

/// "vel" of "vel.x"; empty where the name does not end like that.
std::string baseOfComponent(const std::string& name) {
    const std::string lower = lowerCase(name);
    if (lower.size() < 2 || lower.back() != 'x') return {};
    const bool separated =
        lower.size() > 2 &&
        std::string_view("._").find(lower[lower.size() - 2]) != std::string_view::npos;
    return name.substr(0, name.size() - (separated ? 2 : 1));
}

std::string vectorGrids(const VdbFile& file) {
    std::vector<std::string> names;
    for (const GridListing& grid : file.grids)
        if (grid.usable() && grid.channels == 3) names.push_back(grid.uniqueName);
    return names.empty() ? "it has no vector grids" : "vector grids there: " + joinNames(names);
}

}  // namespace

VelocityGrids findVelocities(const VdbFile& file, std::string_view name) {
    VelocityGrids three = threeComponents(file, name);
    const bool exists = std::any_of(file.grids.begin(), file.grids.end(), [&](const auto& g) {
        return lowerCase(g.uniqueName) == lowerCase(name) || lowerCase(g.name) == lowerCase(name);
    });
    if (!exists && !three.empty()) return three;
    const GridListing grid = findGrid(file, name).grid;
    if (grid.channels == 3) return {grid};
    if (const std::string base = baseOfComponent(grid.name); !base.empty()) {
        three = threeComponents(file, base);
        if (!three.empty()) return three;
    }
    throw inputError(
        "grid '{}' in {} is of type {}; velocities are a vector grid, or three scalar ones such as "
        "vel.x, vel.y and vel.z; {}",
        grid.uniqueName, file.path.string(), grid.valueType, vectorGrids(file));
}

VelocityGrids findVelocities(const VdbFile& file) {
    for (std::string_view name : namesOf(GridRole::Velocity)) {
        const auto* grid = firstWhere(file, [&](const GridListing& g) {
            return lowerCase(g.name) == name && g.channels == 3;
        });
        if (grid) return {*grid};
    }
    for (std::string_view name : namesOf(GridRole::Velocity))
        if (VelocityGrids three = threeComponents(file, name); !three.empty()) return three;
    const auto* onFaces = firstWhere(file, [](const GridListing& g) {
        return g.channels == 3 && g.gridClass == GridClass::Staggered;
    });
    return onFaces ? VelocityGrids{*onFaces} : VelocityGrids{};
}

bool isNamedFor(const GridListing& grid, GridRole role) {
    const auto names = namesOf(role);
    return std::find(names.begin(), names.end(), lowerCase(grid.name)) != names.end();
}

bool meansVelocity(const GridListing& grid) {
    const std::string lower = lowerCase(grid.name);
    const auto names = namesOf(GridRole::Velocity);
    return grid.gridClass == GridClass::Staggered ||
           std::find(names.begin(), names.end(), lower) != names.end() ||
           lower.starts_with("vel.") || lower.starts_with("velocity");
}

bool hasRole(const VdbFile& file, GridRole role) { return findByRoleName(file, role) != nullptr; }

}  // namespace woodcock::grid
