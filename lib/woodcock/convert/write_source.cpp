// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/convert/formats/nanovdb.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/convert/openvdb_each_type.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

namespace {

void sayLoss(const std::string& why, PrecisionLoss loss, const ConvertOptions& options) {
    say(options.info, fmt::format("{}: values change by {:.3g} at most, relatively by {:.3g}", why,
                                  loss.absolute, loss.relative));
}

void applyPrecision(grid::VdbGrids& grids, const ConvertOptions& options) {
    const PrecisionLoss loss = setPrecision(grids, options.precision);
    if (options.precision == Precision::Half || options.precision == Precision::Float)
        sayLoss(options.precision == Precision::Half ? "--precision half" : "--precision float",
                loss, options);
}

bool allSavedAsHalf(const grid::VdbGrids& grids) {
    return std::all_of(grids.grids.begin(), grids.grids.end(),
                       [](const auto& grid) { return grid->saveFloatAsHalf(); });
}

void sayWritten(const fs::path& out, const grid::VdbGrids& grids, const ConvertOptions& options) {
    std::string contents;
    for (const openvdb::GridBase::Ptr& grid : grids.grids)
        contents += fmt::format("'{}' ({}), {} active voxels; ", grid->getName(), grid->valueType(),
                                grid->activeVoxelCount());
    say(options.info,
        fmt::format("wrote {}: {}{} bytes", out.string(), contents, bytesOfFile(out)));
}

/// NanoVDB's own programs know floats, so doubles are kept only where they are asked for.
void useFloats(grid::VdbGrids& grids, const ConvertOptions& options) {
    const PrecisionLoss loss = setPrecision(grids, Precision::Float);
    if (options.precision == Precision::Float)
        sayLoss("--precision float", loss, options);
    else if (loss.absolute > 0)
        sayLoss("doubles are written as floats (--precision double keeps them)", loss, options);
}

/// Doubles as they are asked for; NanoVDB's own code cannot write vectors of them.
void useDoubles(grid::VdbGrids& grids, const ConvertOptions& options) {
    for (openvdb::GridBase::Ptr& grid : grids.grids) {
        grid::VdbGrids one{{grid}};
        const bool vectors =
            grid->isType<openvdb::Vec3SGrid>() || grid->isType<openvdb::Vec3DGrid>();
        const PrecisionLoss loss =
            setPrecision(one, vectors ? Precision::Float : Precision::Double);
        grid = one.grids.front();
        if (!vectors) continue;
        say(options.warn, fmt::format("'{}' is written as vec3s: NanoVDB writes no vectors of "
                                      "doubles; values change by {:.3g} at most, relatively by "
                                      "{:.3g}",
                                      grid->getName(), loss.absolute, loss.relative));
    }
}

void warnOfVectors(const grid::VdbGrids& grids, const ConvertOptions& options) {
    for (const openvdb::GridBase::Ptr& grid : grids.grids)
        if (grid->isType<openvdb::Vec3SGrid>())
            say(options.warn,
                fmt::format("'{}' stays vec3s: NanoVDB has no smaller vectors", grid->getName()));
}

/// The names by which --grid chooses.
std::vector<std::string> namesOf(const Source& source) {
    if (source.uniqueNames.size() == source.grids.grids.size()) return source.uniqueNames;
    std::vector<std::string> names;
    for (const auto& grid : source.grids.grids) names.push_back(grid->getName());
    return names;
}

std::size_t chooseGrid(const Source& source) {
    if (source.grids.grids.size() == 1) return 0;
    throw inputError("there are several grids, and a dense file holds one; choose it by --grid: {}",
                     joinNames(namesOf(source)));
}

std::optional<SampleType> outputTypeOf(const ConvertOptions& options) {
    return options.precision == Precision::Half ? SampleType::F16 : options.outputType;
}

}  // namespace

void writeVdbSource(const fs::path& in, const fs::path& out, grid::VdbGrids& grids,
                    const ConvertOptions& options) {
    applyPrecision(grids, options);
    grid::VdbWriteOptions how;
    // Halves stay halves where no value has changed.
    how.half = options.precision == Precision::Half ||
               (options.precision == Precision::Source && options.values.remap.identity() &&
                allSavedAsHalf(grids));
    how.compression = options.compression.value_or(grid::VdbCompression::Blosc);
    how.metadata = {{"generator", fmt::format("woodcock {}", version())},
                    {"source", in.filename().string()}};
    grid::writeVdb(out, grids, how);
    sayWritten(out, grids, options);
}

void writeNanoVdbSource(const fs::path&, const fs::path& out, grid::VdbGrids& grids,
                        const ConvertOptions& options) {
    NanoVdbWriteOptions how;
    how.compression = options.compression == grid::VdbCompression::Zip ? NanoVdbCompression::Zip
                      : options.compression == grid::VdbCompression::Blosc
                          ? NanoVdbCompression::Blosc
                          : NanoVdbCompression::None;
    how.quantise = options.precision == Precision::Half;
    if (options.precision == Precision::Double)
        useDoubles(grids, options);
    else
        useFloats(grids, options);
    if (how.quantise) warnOfVectors(grids, options);
    const NanoVdbLoss loss = writeNanoVdb(out, grids, how);
    if (how.quantise)
        sayLoss("--precision half: Fp16, 16 bits between the extremes of each 8x8x8 voxels",
                {loss.absolute, loss.relative}, options);
    sayWritten(out, grids, options);
}

void writeDenseSource(const fs::path& out, Source& source, const DenseWriter& writer,
                      const ConvertOptions& options) {
    const std::size_t chosen = chooseGrid(source);
    applyPrecision(source.grids, options);
    const std::optional<Box3i> box = options.bounds ? options.bounds : source.box;
    DenseVolume volume = vdbToDense(source.grids, chosen, box);
    source.grids.grids.clear();
    straighten(volume);
    const std::optional<SampleType> type = outputTypeOf(options);
    const bool packed = options.compression == grid::VdbCompression::Zip;
    const double error = writer.write(out, volume, {type, packed, stageOf(options, "writing")});
    volume.type = type.value_or(writer.onlyType.value_or(volume.type));
    say(options.info,
        fmt::format("wrote {}: {}, {} bytes", out.string(), volume.describe(), fs::file_size(out)));
    if (error > 0 && options.outputType)
        say(options.info, fmt::format("--out-type {}: values change by {:.3g} at most",
                                      sampleTypeName(volume.type), error));
    else if (error > 0 && options.precision == Precision::Source)
        say(options.info, fmt::format("numbers of {}: values change by {:.3g} at most",
                                      sampleTypeName(volume.type), error));
}

}  // namespace woodcock::convert
