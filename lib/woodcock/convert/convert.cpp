// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/convert.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/convert/nanovdb_file.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/convert/openvdb_each_type.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/grid/openvdb_grids.h"
#include "woodcock/grid/openvdb_transform.h"
#include "woodcock/grid/vdb_grids_read.h"

namespace woodcock {

namespace fs = std::filesystem;

void say(const std::function<void(const std::string&)>& log, const std::string& text) {
    if (log && !text.empty()) log(text);
}

namespace {

using ReadSource = Source (*)(const fs::path&, const ConvertOptions&);
using WriteGrids = void (*)(const fs::path& in, const fs::path& out, VdbGrids&,
                            const ConvertOptions&);
using WriteDense = double (*)(const fs::path&, const DenseVolume&, const DenseWriteOptions&);

struct Format {
    const char* name;
    std::vector<std::string> extensions;
    const char* what;
    ReadSource read = nullptr;
    WriteDense writeDense = nullptr;
    WriteGrids writeGrids = nullptr;
};

WorkProgress stage(const ConvertOptions& options, std::string_view name) {
    if (!options.progress) return {};
    return [&options, name](double fraction) { options.progress(name, fraction); };
}

void place(DenseVolume& volume, const Placement& placement) {
    auto& columns = volume.worldFromIndex.column;
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        shortest = std::min(shortest, length(columns[a]));
        longest = std::max(longest, length(columns[a]) * static_cast<double>(volume.dims[a]));
    }
    double factor = 1;
    if (placement.voxel) factor = *placement.voxel / shortest;
    if (placement.size) factor = *placement.size / longest;
    // About the first voxel, so that the volume stays where the file has it.
    if (factor != 1)
        for (Vec3d& column : columns) column = column * factor;
    if (placement.origin) volume.worldFromIndex.translation = *placement.origin;
}

std::string describePlace(const DenseVolume& volume, const Placement& placement) {
    const auto& m = volume.worldFromIndex;
    std::string text = fmt::format(
        "voxels of {:.6g} x {:.6g} x {:.6g}, the first one's centre at ({:.6g}, {:.6g}, {:.6g})",
        length(m.column[0]), length(m.column[1]), length(m.column[2]), m.translation.x,
        m.translation.y, m.translation.z);
    const bool assumed = !volume.placed && !placement.voxel && !placement.size;
    return assumed ? text + "; assumed, as the file has no sizes: see --voxel, --size, --origin"
                   : text;
}

void append(Source& source, DenseVolume volume, const fs::path& in, const ConvertOptions& options) {
    for (const std::string& note : volume.notes) say(options.warn, note);
    const std::string contents = volume.describe();
    if (options.channel) volume = selectChannel(std::move(volume), *options.channel);
    applyAxisOrder(volume, options.axes);
    straighten(volume);
    place(volume, options.placement);
    ValueSummary found;
    VdbGrids made = denseToVdb(volume, options.values, found, stage(options, "converting"));
    say(options.warn, requireSound(found, fmt::format("{}: '{}'", in.string(), volume.name),
                                   options.values.repair));
    say(options.info, fmt::format("read '{}' from {}: {}, values {:.6g} to {:.6g}", volume.name,
                                  in.string(), contents, found.min, found.max));
    say(options.info,
        fmt::format("'{}': {}", volume.name, describePlace(volume, options.placement)));
    if (found.active == 0)
        say(options.warn, fmt::format("'{}' is empty: all of its {} voxels are zero{}", volume.name,
                                      volume.voxels(),
                                      options.values.remap.identity() ? "" : " after remapping"));
    const Vec3i last{static_cast<int>(volume.dims[0]) - 1, static_cast<int>(volume.dims[1]) - 1,
                     static_cast<int>(volume.dims[2]) - 1};
    source.box = Box3i{{0, 0, 0}, last};
    source.grids.grids.push_back(made.grids.front());
}

Source fromVolume(DenseVolume volume, const fs::path& in, const ConvertOptions& options) {
    if (options.name) volume.name = *options.name;
    Source source;
    append(source, std::move(volume), in, options);
    return source;
}

Source readRawSource(const fs::path& in, const ConvertOptions& options) {
    if (!options.dims || !options.type)
        throw usageError(
            "'{}' is a file of bare numbers: say how many by --dims X,Y,Z and of which kind by "
            "--type u8|u16|f32|...",
            in.string());
    return fromVolume(
        readRaw(in, {*options.dims, options.channels.value_or(1), *options.type,
                     options.bigEndian.value_or(false), options.headerBytes.value_or(0)}),
        in, options);
}

Source readNpySource(const fs::path& in, const ConvertOptions& options) {
    return fromVolume(readNpy(in), in, options);
}

Source readMitsubaSource(const fs::path& in, const ConvertOptions& options) {
    return fromVolume(readMitsubaVolume(in), in, options);
}

Source readNrrdSource(const fs::path& in, const ConvertOptions& options) {
    return fromVolume(readNrrd(in), in, options);
}

Source readImagesSource(const fs::path& in, const ConvertOptions& options) {
    return fromVolume(readImageStack(in, stage(options, "reading")), in, options);
}

Source readPbrtSource(const fs::path& in, const ConvertOptions& options) {
    std::vector<DenseVolume> volumes = readPbrtGrids(in, options.grid);
    if (options.name && volumes.size() == 1) volumes.front().name = *options.name;
    Source source;
    for (DenseVolume& volume : volumes) {
        append(source, std::move(volume), in, options);
        volume = {};
    }
    return source;
}

void turn(openvdb::GridBase& grid, const AxisOrder& axes, const Affine3d& worldFromIndex) {
    grid.setTransform(openVdbTransform(axes.map() * worldFromIndex));
}

/// Names, turns and remaps the grids of a file, as the options say.
void finishGrids(Source& source, const fs::path& in, const ConvertOptions& options) {
    for (const openvdb::GridBase::Ptr& grid : source.grids.grids)
        if (!options.axes.identity())
            turn(*grid, options.axes, affineOf(*grid->transform().baseMap()));
    if (options.name) {
        if (source.grids.grids.size() > 1)
            throw usageError("--name is for one grid, and {} has {}; choose one by --grid",
                             in.string(), source.grids.grids.size());
        source.grids.grids.front()->setName(*options.name);
    }
    ValueSummary found;
    if (!options.values.remap.identity() || options.values.tolerance > 0 || options.values.repair) {
        remapGrids(source.grids, options.values, found);
        say(options.warn, requireSound(found, in.string(), options.values.repair));
    }
}

void requireNoPlacement(const ConvertOptions& options) {
    const Placement& placement = options.placement;
    if (placement.voxel || placement.size || placement.origin || options.channel)
        throw usageError("--voxel, --size, --origin and --channel are for sources that are no VDB");
}

Source readVdbSource(const fs::path& in, const ConvertOptions& options) {
    requireNoPlacement(options);
    const VdbFile file = listGrids(in);
    std::vector<GridListing> chosen;
    if (options.grid) chosen.push_back(findGrid(file, *options.grid).grid);
    for (const GridListing& grid : file.grids) {
        if (options.grid) break;
        if (isReadable(grid))
            chosen.push_back(grid);
        else
            say(options.warn, fmt::format("grid '{}' of {} is left out: {}", grid.uniqueName,
                                          in.string(), grid.unusable));
    }
    if (chosen.empty()) throw inputError("{} has no grid of numbers", in.string());
    std::vector<std::string> names;
    for (const GridListing& grid : chosen) names.push_back(grid.uniqueName);
    Source source{readVdbGrids(file, names), {}};
    fillLevelSets(source.grids, options);
    useFloatingPoint(source.grids);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        say(options.info, fmt::format("read '{}' ({}) from {}: {} active voxels",
                                      chosen[i].uniqueName, chosen[i].valueType, in.string(),
                                      source.grids.grids[i]->activeVoxelCount()));
    }
    finishGrids(source, in, options);
    return source;
}

Source readNanoVdbSource(const fs::path& in, const ConvertOptions& options) {
    requireNoPlacement(options);
    Source source{readNanoVdb(in), {}};
    std::vector<std::string> names;
    for (const auto& grid : source.grids.grids) {
        names.push_back(grid->getName());
        say(options.info, fmt::format("read '{}' ({}) from {}: {} active voxels", grid->getName(),
                                      grid->valueType(), in.string(), grid->activeVoxelCount()));
    }
    if (options.grid) {
        std::erase_if(source.grids.grids,
                      [&](const auto& grid) { return grid->getName() != *options.grid; });
        if (source.grids.grids.empty())
            throw inputError("grid '{}' not found in {}; it has: {}", *options.grid, in.string(),
                             joinNames(names));
    }
    fillLevelSets(source.grids, options);
    finishGrids(source, in, options);
    return source;
}

void applyPrecision(VdbGrids& grids, Precision precision, const ConvertOptions& options) {
    const PrecisionLoss loss = setPrecision(grids, precision);
    if (precision == Precision::Half || precision == Precision::Float)
        say(options.info,
            fmt::format("--precision {}: values change by {:.3g} at most, relatively by {:.3g}",
                        precision == Precision::Half ? "half" : "float", loss.absolute,
                        loss.relative));
}

bool allSavedAsHalf(const VdbGrids& grids) {
    return std::all_of(grids.grids.begin(), grids.grids.end(),
                       [](const auto& grid) { return grid->saveFloatAsHalf(); });
}

void sayWritten(const fs::path& out, const VdbGrids& grids, const ConvertOptions& options) {
    std::string contents;
    for (const openvdb::GridBase::Ptr& grid : grids.grids)
        contents += fmt::format("'{}' ({}), {} active voxels; ", grid->getName(), grid->valueType(),
                                grid->activeVoxelCount());
    say(options.info,
        fmt::format("wrote {}: {}{} bytes", out.string(), contents, bytesOfFile(out)));
}

void writeVdbFile(const fs::path& in, const fs::path& out, VdbGrids& grids,
                  const ConvertOptions& options) {
    applyPrecision(grids, options.precision, options);
    VdbWriteOptions how;
    // Halves stay halves, as long as nothing has changed them.
    how.half = options.precision == Precision::Half ||
               (options.precision == Precision::Source && options.values.remap.identity() &&
                allSavedAsHalf(grids));
    how.compression = options.compression;
    how.metadata = {{"generator", fmt::format("woodcock {}", version())},
                    {"source", in.filename().string()}};
    writeVdb(out, grids, how);
    sayWritten(out, grids, options);
}

void writeNanoVdbFile(const fs::path&, const fs::path& out, VdbGrids& grids,
                      const ConvertOptions& options) {
    applyPrecision(grids, Precision::Float, options);
    writeNanoVdb(out, grids);
    sayWritten(out, grids, options);
}

const std::vector<Format>& formats() {
    static const std::vector<Format> all{
        {"vdb", {".vdb"}, "OpenVDB", readVdbSource, nullptr, writeVdbFile},
        {"nvdb", {".nvdb"}, "NanoVDB", readNanoVdbSource, nullptr, writeNanoVdbFile},
        {"raw", {".raw", ".bin", ".dat"}, "bare numbers", readRawSource, writeRaw},
        {"npy", {".npy"}, "NumPy", readNpySource, writeNpy},
        {"vol", {".vol"}, "Mitsuba", readMitsubaSource, writeMitsubaVolume},
        {"nrrd", {".nrrd"}, "nearly raw raster data", readNrrdSource, writeNrrd},
        {"pbrt", {".pbrt"}, "pbrt's grid media", readPbrtSource},
        {"mesh", {".obj", ".stl", ".gltf", ".glb"}, "triangles", readMeshSource},
        {"ply", {".ply"}, "triangles or points", readPlySource},
        {"points", {".csv", ".txt", ".xyz"}, "a table of points", readPointsSource},
        {"images", {}, "slices: names with #### or %04d", readImagesSource}};
    return all;
}

std::string lowerExtension(const fs::path& file) {
    std::string text = file.extension().string();
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string listFormats(bool written) {
    std::string text;
    for (const Format& format : formats()) {
        if (written && !format.writeDense && !format.writeGrids) continue;
        text += (text.empty() ? "" : ", ") + std::string(format.name);
        for (const std::string& extension : format.extensions)
            if (extension.substr(1) != format.name) text += " " + extension;
    }
    return text;
}

const Format* formatOfName(const fs::path& file) {
    const std::string extension = lowerExtension(file);
    for (const Format& format : formats())
        if (std::find(format.extensions.begin(), format.extensions.end(), extension) !=
            format.extensions.end())
            return &format;
    return nullptr;
}

const Format& inputFormat(const fs::path& in, const ConvertOptions& options) {
    if (options.from) {
        std::vector<std::string> names;
        for (const Format& format : formats()) {
            if (format.name == *options.from) return format;
            names.emplace_back(format.name);
        }
        throw usageError("--from: unknown format '{}'{}", *options.from,
                         suggestName(*options.from, "known", names));
    }
    if (isImagePattern(in)) return formats().back();
    if (const Format* format = formatOfName(in)) return *format;
    throw inputError("the name of '{}' tells no format that is known; known: {} (--from names one)",
                     in.string(), listFormats(false));
}

const Format& outputFormat(const fs::path& out) {
    const Format* format = formatOfName(out);
    if (format && (format->writeGrids || format->writeDense)) return *format;
    throw usageError("the name of '{}' tells no format that can be written; these can: {}",
                     out.string(), listFormats(true));
}

/// Options that would be ignored are mistakes.
void checkOptions(const Format& from, const Format& to, const ConvertOptions& options) {
    const std::string_view name = from.name;
    if (name != "raw" && (options.dims || options.type || options.channels || options.bigEndian ||
                          options.headerBytes))
        throw usageError(
            "--dims, --type, --channels, --endian and --header are for raw files; this one is {} "
            "(--from raw forces it)",
            from.what);
    if (options.grid && name != "vdb" && name != "nvdb" && name != "pbrt")
        throw usageError("--grid is for VDB files and pbrt scenes; this one is {}", from.what);
    const bool shape = name == "mesh" || name == "ply" || name == "points";
    if ((options.band && !shape && name != "vdb" && name != "nvdb") ||
        ((options.radius || options.shell) && !shape))
        throw usageError(
            "--band, --shell and --radius are for meshes, points and level sets; this one is {}",
            from.what);
    if (to.writeGrids && (options.outputType || options.bounds))
        throw usageError("--out-type and --bounds are for dense formats, and VDB is none");
    if (to.writeDense && options.precision == Precision::Half)
        throw usageError("--precision half is for VDB; dense formats have --out-type");
}

std::size_t chooseGrid(const VdbGrids& grids) {
    if (grids.grids.size() == 1) return 0;
    std::vector<std::string> names;
    for (const auto& grid : grids.grids) names.push_back(grid->getName());
    throw inputError("there are several grids, and a dense file holds one; choose it by --grid: {}",
                     joinNames(names));
}

void writeDenseFile(const fs::path& out, Source& source, const Format& format,
                    const ConvertOptions& options) {
    applyPrecision(source.grids, options.precision, options);
    const std::optional<Box3i> box = options.bounds ? options.bounds : source.box;
    DenseVolume volume = vdbToDense(source.grids, chooseGrid(source.grids), box);
    source.grids.grids.clear();
    straighten(volume);
    const double error =
        format.writeDense(out, volume, {options.outputType, stage(options, "writing")});
    volume.type = options.outputType.value_or(volume.type);
    say(options.info,
        fmt::format("wrote {}: {}, {} bytes", out.string(), volume.describe(), fs::file_size(out)));
    if (error > 0)
        say(options.info, fmt::format("--out-type {}: values change by {:.3g} at most",
                                      sampleTypeName(volume.type), error));
}

}  // namespace

void convert(const fs::path& in, const fs::path& out, const ConvertOptions& options) {
    const Format& from = inputFormat(in, options);
    const Format& to = outputFormat(out);
    checkOptions(from, to, options);
    if (sameFile(in, out)) throw usageError("'{}' is the input and the output", in.string());
    checkWritable(out);
    openvdb::initialize();
    Source source = from.read(in, options);
    if (to.writeGrids)
        to.writeGrids(in, out, source.grids, options);
    else
        writeDenseFile(out, source, to, options);
}

std::string describeFormats() {
    std::string text;
    for (const Format& format : formats()) {
        std::string extensions;
        for (const std::string& extension : format.extensions) extensions += " " + extension;
        text += fmt::format(
            "  {:7} {}{}{}\n", format.name, format.what, extensions.empty() ? "" : ":" + extensions,
            format.writeGrids || format.writeDense ? " (read and written)" : " (read)");
    }
    return text;
}

}  // namespace woodcock
