// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/load_albedo.h"

#include <algorithm>
#include <atomic>

#include "woodcock/base/error.h"

namespace woodcock::scene {
namespace {

/// Sets values above 1 to 1; returns how many voxels (of `channels` values) had one.
std::uint64_t limit(std::span<float> values, int channels) {
    std::uint64_t count = 0;
    const auto step = static_cast<size_t>(channels);
    for (size_t i = 0; i + step <= values.size(); i += step) {
        const auto voxel = values.subspan(i, step);
        count += std::any_of(voxel.begin(), voxel.end(), [](float v) { return v > 1; });
        for (float& v : voxel) v = std::min(v, 1.0f);
    }
    return count;
}

}  // namespace

std::string limitAlbedo(const grid::VdbFile& file, const grid::GridListing& grid,
                        const grid::LoadOptions& options, grid::Field& field) {
    const float largest = field.range().max;
    if (!(largest > 1)) return {};

    // Rare enough to read the voxels once more.
    grid::FieldSource source =
        grid::readGridSource(file, grid, {options.repair, options.repair}).field;
    std::atomic<std::uint64_t> count = 0;
    const auto channels = static_cast<size_t>(source.channels);
    for (grid::FieldTile& tile : source.tiles)
        if (limit(std::span(tile.value).first(channels), source.channels) > 0)
            count += static_cast<std::uint64_t>(tile.size) * static_cast<std::uint64_t>(tile.size) *
                     static_cast<std::uint64_t>(tile.size);
    limit(std::span(source.background).first(channels), source.channels);
    source.copyLeaf = [&, copy = source.copyLeaf](size_t i, std::span<float> values) {
        copy(i, values);
        count += limit(values, source.channels);
    };
    grid::Field limited = grid::buildField(source, field.storage());

    const std::string found =
        fmt::format("albedo grid '{}' in {} holds {} voxel{} above 1 (up to {})", grid.uniqueName,
                    file.path.string(), count.load(), count == 1 ? "" : "s", largest);
    if (!options.repair)
        throw inputError(
            "{}; an albedo lies between 0 and 1: --repair (in a scene file: repair = "
            "true) sets them to 1",
            found);
    field = std::move(limited);
    return found + ": set to 1";
}

}  // namespace woodcock::scene
