// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "woodcock/base/error.h"
#include "woodcock/convert/openvdb_convert_source.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

WorkProgress stageOf(const ConvertOptions& options, std::string_view name) {
    if (!options.progress) return {};
    return [&options, name](double fraction) { options.progress(name, fraction); };
}

namespace {

/// All three sides, along the axes of the file.
void setSides(DenseVolume& volume, const Placement& placement) {
    if (placement.voxelSides) setVoxelSides(volume, *placement.voxelSides);
    if (!placement.sizeSides) return;
    Vec3d sides = *placement.sizeSides;
    for (int a = 0; a < 3; ++a)
        sides[a] /= static_cast<double>(volume.dims[static_cast<std::size_t>(a)]);
    setVoxelSides(volume, sides);
}

/// The shortest side of a voxel, or the longest of the volume.
void setSize(DenseVolume& volume, const Placement& placement) {
    auto& columns = volume.worldFromIndex.column;
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        shortest = std::min(shortest, length(columns[a]));
        longest = std::max(longest, length(columns[a]) * static_cast<double>(volume.dims[a]));
    }
    double factor = 1;
    if (placement.voxel) factor = *placement.voxel / shortest;
    if (placement.size) factor = *placement.size / longest;
    // Scaled about the first voxel, so that the volume stays where the file places it.
    if (factor != 1)
        for (Vec3d& column : columns) column = column * factor;
}

void place(DenseVolume& volume, const ConvertOptions& options) {
    const Placement& placement = options.placement;
    if (volume.unitCube && placement.sized()) volume.worldFromIndex = {};
    setSides(volume, placement);
    applyAxisOrder(volume, options.axes);
    straighten(volume);
    setSize(volume, placement);
    if (placement.origin) volume.worldFromIndex.translation = *placement.origin;
}

std::string describePlace(const DenseVolume& volume, const Placement& placement) {
    const auto& m = volume.worldFromIndex;
    std::string text = fmt::format(
        "voxels of {:.6g} x {:.6g} x {:.6g}, the first one's centre at ({:.6g}, {:.6g}, {:.6g})",
        length(m.column[0]), length(m.column[1]), length(m.column[2]), m.translation.x,
        m.translation.y, m.translation.z);
    const bool assumed = !volume.placed && !volume.unitCube && !placement.sized();
    return assumed
               ? text +
                     "; assumed, as the file gives no sizes; set them by --voxel, --size, --origin"
               : text;
}

/// Hounsfield units of computed tomography: air is -1000, water 0. Scanners write values from
/// -1024, or down to -3024 outside of their view.
void hintAtHounsfield(const DenseVolume& volume, const ValueSummary& found,
                      const ConvertOptions& options) {
    if (volume.channels != 1 || !options.values.remap.identity()) return;
    if (!(found.min <= -900 && found.min >= -3100 && found.max >= 100 && found.max <= 33000))
        return;
    say(options.warn,
        fmt::format(
            "'{}' has values from {:.6g} to {:.6g}, which look like Hounsfield units (air -1000, "
            "water 0). A density must not be negative: --scale 0.001 --offset 1 --clamp 0,5 makes "
            "air 0 and water 1. Add --threshold 0.5 to leave out what is nearly air",
            volume.name, found.min, found.max));
}

void noteColour(const DenseVolume& volume, const ConvertOptions& options) {
    if (volume.channels == 3)
        say(options.info,
            fmt::format(
                "'{}' becomes a vec3 grid of its three channels, a density for each of red, green "
                "and blue. --name Cd makes it a colour; --channel takes one channel",
                volume.name));
}

void requireChoiceFromList(const DenseVolume& volume, const fs::path& in) {
    if (!volume.list.empty() && volume.channels > 1)
        throw inputError(
            "{}: '{}' has {} {}, each a volume of {} x {} x {}; choose one by "
            "--channel, 0 to {}",
            in.string(), volume.name, volume.channels, volume.list, volume.dims[0], volume.dims[1],
            volume.dims[2], volume.channels - 1);
}

void append(Source& source, DenseVolume volume, const fs::path& in, const ConvertOptions& options) {
    for (const std::string& note : volume.notes) say(options.warn, note);
    const std::string contents = volume.describe();
    if (options.channel) volume = selectChannel(std::move(volume), *options.channel);
    requireChoiceFromList(volume, in);
    place(volume, options);
    ValueSummary found;
    grid::VdbGrids made = denseToVdb(volume, options.values, found, stageOf(options, "converting"));
    say(options.warn, requireSound(found, fmt::format("{}: '{}'", in.string(), volume.name),
                                   options.values.repair));
    say(options.info, fmt::format("read '{}' from {}: {}, values {:.6g} to {:.6g}", volume.name,
                                  in.string(), contents, found.min, found.max));
    say(options.info,
        fmt::format("'{}': {}", volume.name, describePlace(volume, options.placement)));
    noteColour(volume, options);
    hintAtHounsfield(volume, found, options);
    if (found.active == 0)
        say(options.warn, fmt::format("'{}' is empty: all of its {} voxels are zero{}", volume.name,
                                      volume.voxels(),
                                      options.values.remap.identity() ? "" : " after remapping"));
    const Vec3i last{static_cast<int>(volume.dims[0]) - 1, static_cast<int>(volume.dims[1]) - 1,
                     static_cast<int>(volume.dims[2]) - 1};
    source.box = Box3i{{0, 0, 0}, last};
    source.grids.grids.push_back(made.grids.front());
}

}  // namespace

Source sourceOf(std::vector<DenseVolume> volumes, const fs::path& in,
                const ConvertOptions& options) {
    if (options.name && volumes.size() > 1)
        throw usageError("--name is for one grid, and {} has {}; choose one by --grid", in.string(),
                         volumes.size());
    if (options.name && volumes.size() == 1) volumes.front().name = *options.name;
    Source source;
    for (DenseVolume& volume : volumes) {
        append(source, std::move(volume), in, options);
        volume = {};
    }
    return source;
}

}  // namespace woodcock::convert
