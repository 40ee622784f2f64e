// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/convert.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/convert/formats/nanovdb_write.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/convert/openvdb_each_type.h"
#include "woodcock/grid/foreign_format.h"
#include "woodcock/grid/vdb/openvdb_grids.h"

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

void sayLoss(const std::string& why, PrecisionLoss loss, const ConvertOptions& options) {
    say(options.info, fmt::format("{}: values change by {:.3g} at most, relatively by {:.3g}", why,
                                  loss.absolute, loss.relative));
}

void applyPrecision(VdbGrids& grids, const ConvertOptions& options) {
    const PrecisionLoss loss = setPrecision(grids, options.precision);
    if (options.precision == Precision::Half || options.precision == Precision::Float)
        sayLoss(options.precision == Precision::Half ? "--precision half" : "--precision float",
                loss, options);
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
    applyPrecision(grids, options);
    VdbWriteOptions how;
    // Halves stay halves, as long as nothing has changed them.
    how.half = options.precision == Precision::Half ||
               (options.precision == Precision::Source && options.values.remap.identity() &&
                allSavedAsHalf(grids));
    how.compression = options.compression.value_or(VdbCompression::Blosc);
    how.metadata = {{"generator", fmt::format("woodcock {}", version())},
                    {"source", in.filename().string()}};
    writeVdb(out, grids, how);
    sayWritten(out, grids, options);
}

/// NanoVDB's own programs know floats, so doubles are kept only where they are asked for.
void useFloats(VdbGrids& grids, const ConvertOptions& options) {
    const PrecisionLoss loss = setPrecision(grids, Precision::Float);
    if (options.precision == Precision::Float)
        sayLoss("--precision float", loss, options);
    else if (loss.absolute > 0)
        sayLoss("doubles are written as floats, unless by --precision double", loss, options);
}

/// Doubles as they are asked for; NanoVDB's own code cannot write vectors of them.
void useDoubles(VdbGrids& grids, const ConvertOptions& options) {
    for (openvdb::GridBase::Ptr& grid : grids.grids) {
        VdbGrids one{{grid}};
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

void warnOfVectors(const VdbGrids& grids, const ConvertOptions& options) {
    for (const openvdb::GridBase::Ptr& grid : grids.grids)
        if (grid->isType<openvdb::Vec3SGrid>())
            say(options.warn,
                fmt::format("'{}' stays vec3s: NanoVDB has no smaller vectors", grid->getName()));
}

void writeNanoVdbFile(const fs::path&, const fs::path& out, VdbGrids& grids,
                      const ConvertOptions& options) {
    NanoVdbWriteOptions how;
    how.compression = options.compression == VdbCompression::Zip     ? NanoVdbCompression::Zip
                      : options.compression == VdbCompression::Blosc ? NanoVdbCompression::Blosc
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

const std::vector<Format>& formats() {
    static const std::vector<Format> all{
        {"vdb", {".vdb"}, "OpenVDB", readGridsSource, nullptr, writeVdbFile},
        {"nvdb", {".nvdb"}, "NanoVDB", readGridsSource, nullptr, writeNanoVdbFile},
        {"raw", {".raw", ".bin", ".dat"}, "bare numbers", readRawSource, writeRaw},
        {"npy", {".npy"}, "NumPy", readNpySource, writeNpy},
        {"npz", {".npz"}, "NumPy's archive", readNpzSource},
        {"vol", {".vol"}, "Mitsuba", readMitsubaSource, writeMitsubaVolume},
        {"nrrd", {".nrrd", ".nhdr"}, "nearly raw raster data", readNrrdSource, writeNrrd},
        {"pbrt", {".pbrt"}, "pbrt's grid media", readPbrtSource},
        {"mesh", {".obj", ".stl", ".gltf", ".glb"}, "triangles", readMeshSource},
        {"ply", {".ply"}, "triangles or points", readPlySource},
        {"points", {".csv", ".txt", ".xyz"}, "a table of points", readPointsSource},
        {"tiff", {".tif", ".tiff"}, "pages of one file", readPagesSource},
        {"images", {}, "slices: names with #### or %04d, or a list", readImagesSource}};
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

bool isPicture(const fs::path& file) {
    static constexpr std::string_view endings[]{".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg",
                                                ".bmp", ".tga", ".dpx",  ".hdr", ".pgm", ".webp"};
    const std::string extension = lowerExtension(file);
    return std::find(std::begin(endings), std::end(endings), extension) != std::end(endings);
}

/// Formats that are not read are told by their bytes, whatever the name says.
void refuseForeign(const fs::path& in, const Format* named) {
    const auto foreign = foreignFormat(in);
    if (!foreign || foreign->readByConvert) return;
    if (named && (!foreign->knownByContent || foreign->archive)) return;
    throw inputError("{} is {}, which is not read; {}", in.string(), foreign->what, foreign->way);
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
    const Format* const named = formatOfName(in);
    refuseForeign(in, named);
    if (isImagePattern(in)) return formats().back();
    if (named) return *named;
    std::error_code ignored;
    if (fs::is_directory(in, ignored))
        throw inputError(
            "'{}' is a folder; of a stack of slices name the files, as {}; of a DICOM series load "
            "the folder into 3D Slicer and save it as .nrrd, or run `dcm2niix -e y {}`",
            in.string(), (in / "slice.####.png").string(), in.string());
    if (isPicture(in))
        throw inputError(
            "'{}' is one picture, and a volume needs several: name all of its slices, or their "
            "pattern, as slice.####{}",
            in.string(), in.extension().string());
    throw inputError("the name of '{}' tells no format that is known; known: {} (--from names one)",
                     in.string(), listFormats(false));
}

const Format& outputFormat(const fs::path& out) {
    const Format* format = formatOfName(out);
    if (lowerExtension(out) == ".nhdr")
        throw usageError("cannot write '{}': header and values are written in one file, .nrrd",
                         out.string());
    if (format && (format->writeGrids || format->writeDense)) return *format;
    throw usageError("the name of '{}' tells no format that can be written; these can: {}",
                     out.string(), listFormats(true));
}

/// What each output can keep of --compression and --precision.
void checkOutputOptions(const Format& to, const ConvertOptions& options) {
    const std::string_view name = to.name;
    if (options.compression && to.writeDense && name != "nrrd")
        throw usageError("--compression is for vdb, nvdb and nrrd; {} files are not compressed",
                         name);
    if (options.compression == VdbCompression::Blosc && name == "nrrd")
        throw usageError("--compression: a NRRD file has none or zip (gzip), not blosc");
    if (options.precision == Precision::Source || !to.writeDense) return;
    if (options.outputType)
        throw usageError("--precision and --out-type both say which numbers to write; give one");
    if (options.precision == Precision::Half && (name == "nrrd" || name == "vol"))
        throw usageError(
            "--precision half: {}; vdb, nvdb, npy and raw do",
            name == "vol" ? "a Mitsuba volume holds no halves" : "a NRRD file holds no halves");
    if (options.precision == Precision::Double && name == "vol")
        throw usageError("--precision double: a Mitsuba volume holds floats alone");
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
    if (options.grid && name != "vdb" && name != "nvdb" && name != "pbrt" && name != "npz")
        throw usageError("--grid is for VDB files, pbrt scenes and .npz; this one is {}",
                         from.what);
    const bool shape = name == "mesh" || name == "ply" || name == "points";
    if ((options.band && !shape && name != "vdb" && name != "nvdb") ||
        (options.radius && !shape && name != "vdb") || (options.shell && !shape))
        throw usageError(
            "--band, --shell and --radius are for meshes, points and level sets; this one is {}",
            from.what);
    if (options.columns && name != "points" && name != "ply")
        throw usageError("--columns is for tables of points; this one is {}", from.what);
    if (to.writeGrids && (options.outputType || options.bounds))
        throw usageError("--out-type and --bounds are for dense formats, and VDB is none");
    checkOutputOptions(to, options);
}

/// As --grid would choose them.
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

void writeDenseFile(const fs::path& out, Source& source, const Format& format,
                    const ConvertOptions& options) {
    const std::size_t chosen = chooseGrid(source);
    applyPrecision(source.grids, options);
    const std::optional<Box3i> box = options.bounds ? options.bounds : source.box;
    DenseVolume volume = vdbToDense(source.grids, chosen, box);
    source.grids.grids.clear();
    straighten(volume);
    const std::optional<SampleType> type = outputTypeOf(options);
    const bool packed = options.compression == VdbCompression::Zip;
    const double error =
        format.writeDense(out, volume, {type, packed, stageOf(options, "writing")});
    volume.type =
        type.value_or(std::string_view(format.name) == "vol" ? SampleType::F32 : volume.type);
    say(options.info,
        fmt::format("wrote {}: {}, {} bytes", out.string(), volume.describe(), fs::file_size(out)));
    if (error > 0 && options.outputType)
        say(options.info, fmt::format("--out-type {}: values change by {:.3g} at most",
                                      sampleTypeName(volume.type), error));
    else if (error > 0 && options.precision == Precision::Source)
        say(options.info, fmt::format("numbers of {}: values change by {:.3g} at most",
                                      sampleTypeName(volume.type), error));
}

void write(const fs::path& in, const fs::path& out, Source& source, const Format& to,
           const ConvertOptions& options) {
    if (to.writeGrids)
        to.writeGrids(in, out, source.grids, options);
    else
        writeDenseFile(out, source, to, options);
}

void requirePictures(const std::vector<fs::path>& in, const ConvertOptions& options) {
    if (options.from && *options.from != "images")
        throw usageError("--from {}: of several inputs only pictures make one volume",
                         *options.from);
    for (const fs::path& file : in)
        if (!options.from && !isPicture(file))
            throw usageError(
                "several inputs are the slices of one volume, and '{}' is no picture; convert "
                "other files one by one",
                file.string());
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
    write(in, out, source, to, options);
}

void convert(const std::vector<fs::path>& in, const fs::path& out, const ConvertOptions& options) {
    if (in.size() == 1) return convert(in.front(), out, options);
    if (in.empty()) throw usageError("there is nothing to convert");
    requirePictures(in, options);
    const Format& to = outputFormat(out);
    checkOptions(formats().back(), to, options);
    for (const fs::path& file : in)
        if (sameFile(file, out)) throw usageError("'{}' is an input and the output", file.string());
    checkWritable(out);
    openvdb::initialize();
    Source source = readImageFilesSource(in, options);
    write(in.front(), out, source, to, options);
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
