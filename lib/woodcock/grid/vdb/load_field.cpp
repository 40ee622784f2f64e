// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/load_field.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/grid/grid_roles.h"

namespace woodcock::grid {

namespace {

std::string place(const VdbFile& file, const GridListing& grid) {
    return fmt::format("grid '{}' in {}", grid.uniqueName, file.path.string());
}

void requireUse(const VdbFile& file, const GridListing& grid, GridUse use) {
    if (!grid.usable()) throw inputError("{} cannot be used: {}", place(file, grid), grid.unusable);
    if (use == GridUse::Colour || grid.channels == 1) return;
    std::vector<std::string> scalars;
    for (const GridListing& other : file.grids)
        if (other.usable() && other.channels == 1) scalars.push_back(other.uniqueName);
    throw inputError(
        "{} is a vector grid ({}) where a scalar one is needed; scalar grids there: {}",
        place(file, grid), grid.valueType, joinNames(scalars));
}

std::string text(std::span<const float> value) {
    return value.size() == 1 ? fmt::format("{}", value[0])
                             : fmt::format("[{}]", fmt::join(value, ", "));
}

/// "grid 'density' in x.vdb is empty: ...", where no voxel is active.
std::string emptyNote(const VdbFile& file, const GridListing& grid, const VoxelScan& voxels) {
    if (voxels.inactiveValues == 0)
        return fmt::format("{} is empty: it has no active voxels", place(file, grid));
    return fmt::format(
        "{} has no active voxels, but {} inactive ones with values other than the background; "
        "activate them if they are meant to be seen (Houdini: VDB Activate)",
        place(file, grid), voxels.inactiveValues);
}

/// Limits the source to the box of its active voxels. Returns a note about what that leaves out, or
/// an empty text.
std::string limitReach(const VdbFile& file, const GridListing& grid, const Box3i& active,
                       FieldSource& source) {
    if (active.empty()) {  // then inactive values are left out too
        const int channels = source.channels;
        source = {};
        source.channels = channels;
        return {};
    }
    const auto channels = static_cast<std::size_t>(source.channels);
    const std::span<const float> background(source.background.data(), channels);
    if (std::all_of(background.begin(), background.end(), [](float v) { return v == 0; }))
        return {};
    source.within = active;
    return fmt::format(
        "{} has a background of {}: only what lies within the bounds of its active "
        "voxels is drawn",
        place(file, grid), text(background));
}

/// Returns a note about what was repaired, or an empty text.
std::string requireSoundValues(const VdbFile& file, const GridListing& grid,
                               const GridStatistics& statistics, const LoadOptions& options) {
    const std::string faults = describeFaults(statistics, options.nonNegative);
    if (faults.empty()) return {};
    if (options.repair) return fmt::format("{}: set to zero: {}", place(file, grid), faults);
    throw inputError("{} holds {}; --repair (in a scene file: repair = true) sets them to zero",
                     place(file, grid), faults);
}

double largestOf(Range r) { return std::max(std::abs(r.min), std::abs(r.max)); }

}  // namespace

std::string describeFaults(const GridStatistics& statistics, bool nonNegative) {
    std::string text;
    const auto add = [&](const std::string& fault) { text += (text.empty() ? "" : ", ") + fault; };
    const auto addVoxels = [&](const VoxelCount& voxels, const char* kind) {
        if (voxels.count > 0)
            add(fmt::format("{} {} voxel{} (first at [{}, {}, {}])", voxels.count, kind,
                            voxels.count == 1 ? "" : "s", voxels.first.x, voxels.first.y,
                            voxels.first.z));
    };
    addVoxels(statistics.voxels.nan, "NaN");
    addVoxels(statistics.voxels.infinite, "infinite");
    if (nonNegative) addVoxels(statistics.voxels.negative, "negative");
    for (float v : statistics.background)
        if (!std::isfinite(v) || (nonNegative && v < 0)) {
            add(fmt::format("a background of {}", v));
            break;
        }
    return text;
}

LoadedGrid loadGrid(const VdbFile& file, const GridListing& grid, const LoadOptions& options) {
    requireUse(file, grid, options.use);
    GridSource source =
        readGridSource(file, grid, {.faulty = options.repair, .negative = options.nonNegative});

    LoadedGrid loaded;
    loaded.empty = source.statistics.voxels.active == 0;
    if (loaded.empty) loaded.notes.push_back(emptyNote(file, grid, source.statistics.voxels));
    if (std::string note = requireSoundValues(file, grid, source.statistics, options);
        !note.empty())
        loaded.notes.push_back(std::move(note));
    if (grid.gridClass == GridClass::Staggered && !options.onFaces)
        loaded.notes.push_back(
            fmt::format("{} is staggered: its values belong to the faces of "
                        "voxels, but are drawn at their index positions",
                        place(file, grid)));
    Storage storage = options.storage;
    if (options.convert)
        source.field = options.convert(std::move(source.field));
    else if (storage == Storage::Auto)
        storage = source.statistics.voxels.exactAsHalf ? Storage::Half : Storage::Float;
    if (options.reach == GridReach::ActiveVoxels)
        if (std::string note = limitReach(file, grid, source.statistics.activeBounds, source.field);
            !note.empty())
            loaded.notes.push_back(std::move(note));
    try {
        loaded.field = buildField(source.field, storage);
    } catch (const Error& e) {
        throw Error(e.kind(), fmt::format("{}: {}", place(file, grid), e.what()));
    }
    if (const float error = loaded.field.largestFixedError(); error > 0)
        loaded.notes.push_back(fmt::format(
            "{}: stored as {}: voxels differ by at most {:.3g}, {:.2g} % of the largest",
            place(file, grid), storageName(storage), error,
            100 * double{error} / largestOf(loaded.field.range())));
    loaded.worldFromIndex = *grid.worldFromIndex;
    loaded.statistics = source.statistics;
    return loaded;
}

LoadedGrid loadGrid(const std::filesystem::path& path, std::string_view gridName,
                    const LoadOptions& options) {
    const VdbFile file = listGrids(path);
    const FoundGrid found = findGrid(file, gridName);
    LoadedGrid loaded = loadGrid(file, found.grid, options);
    if (!found.note.empty()) loaded.notes.insert(loaded.notes.begin(), found.note);
    return loaded;
}

}  // namespace woodcock::grid
