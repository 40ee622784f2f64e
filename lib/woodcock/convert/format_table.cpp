// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/format_table.h"

#include <algorithm>
#include <cctype>

#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/grid/foreign_format.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

namespace {

// Adapters of the readers of convert/formats.

ReadSource volume(DenseVolume (*read)(const fs::path&)) {
    return [read](const fs::path& in, const ConvertOptions& options) {
        return sourceOf({read(in)}, in, options);
    };
}

ReadSource slices(DenseVolume (*read)(const fs::path&, const WorkProgress&)) {
    return [read](const fs::path& in, const ConvertOptions& options) {
        return sourceOf({read(in, stageOf(options, "reading"))}, in, options);
    };
}

/// Several volumes, among which --grid chooses.
ReadSource volumes(std::vector<DenseVolume> (*read)(const fs::path&,
                                                    const std::optional<std::string>&)) {
    return [read](const fs::path& in, const ConvertOptions& options) {
        return sourceOf(read(in, options.grid), in, options);
    };
}

Source readRawSource(const fs::path& in, const ConvertOptions& options) {
    if (!options.dims || !options.type)
        throw usageError(
            "'{}' is a file of numbers without a header: give their count by --dims X,Y,Z and "
            "their type by --type u8|u16|f32|...",
            in.string());
    return sourceOf(
        {readRaw(in, {*options.dims, options.channels.value_or(1), *options.type,
                      options.bigEndian.value_or(false), options.headerBytes.value_or(0)})},
        in, options);
}

constexpr InputOptions shapeOptions{.band = true, .radius = true, .shell = true};
constexpr InputOptions pointOptions{.band = true, .radius = true, .shell = true, .columns = true};

std::vector<Format> makeFormats() {
    return {{.name = "vdb",
             .extensions = {".vdb"},
             .what = "OpenVDB",
             .read = readGridsSource,
             .writeGrids = writeVdbSource,
             .takes = {.grid = true, .band = true, .radius = true}},
            {.name = "nvdb",
             .extensions = {".nvdb"},
             .what = "NanoVDB",
             .read = readGridsSource,
             .writeGrids = writeNanoVdbSource,
             .takes = {.grid = true, .band = true}},
            {.name = "raw",
             .extensions = {".raw", ".bin", ".dat"},
             .what = "numbers without a header",
             .read = readRawSource,
             .dense = {.write = writeRaw},
             .takes = {.layout = true}},
            {.name = "npy",
             .extensions = {".npy"},
             .what = "NumPy",
             .read = volume(readNpy),
             .dense = {.write = writeNpy}},
            {.name = "npz",
             .extensions = {".npz"},
             .what = "NumPy's archive",
             .read = volumes(readNpz),
             .takes = {.grid = true}},
            {.name = "vol",
             .extensions = {".vol"},
             .what = "Mitsuba",
             .read = volume(readMitsubaVolume),
             .dense = {.write = writeMitsubaVolume, .halves = false, .onlyType = SampleType::F32}},
            {.name = "nrrd",
             .extensions = {".nrrd", ".nhdr"},
             .what = "nearly raw raster data",
             .read = volume(readNrrd),
             .dense = {.write = writeNrrd, .halves = false, .packs = true}},
            {.name = "pbrt",
             .extensions = {".pbrt"},
             .what = "pbrt's grid media",
             .read = volumes(readPbrtGrids),
             .takes = {.grid = true}},
            {.name = "mesh",
             .extensions = {".obj", ".stl", ".gltf", ".glb"},
             .what = "triangles",
             .read = readMeshSource,
             .takes = shapeOptions},
            {.name = "ply",
             .extensions = {".ply"},
             .what = "triangles or points",
             .read = readPlySource,
             .takes = pointOptions},
            {.name = "points",
             .extensions = {".csv", ".txt", ".xyz"},
             .what = "a table of points",
             .read = readPointsSource,
             .takes = pointOptions},
            {.name = "tiff",
             .extensions = {".tif", ".tiff"},
             .what = "pages of one file",
             .read = slices(readImagePages)},
            {.name = "images",
             .extensions = {},
             .what = "slices: names with #### or %04d, or a list",
             .read = slices(readImageStack)}};
}

std::string lowerExtension(const fs::path& file) {
    std::string text = file.extension().string();
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string listFormats(bool written) {
    std::string text;
    for (const Format& format : formats()) {
        if (written && !format.written()) continue;
        text += (text.empty() ? "" : ", ") + format.name;
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

/// Refuses a file of a format that is not read, which its bytes tell, whatever its name is.
void refuseForeign(const fs::path& in, const Format* named) {
    const auto foreign = grid::foreignFormat(in);
    if (!foreign || foreign->readByConvert) return;
    if (named && (!foreign->knownByContent || foreign->archive)) return;
    throw inputError("{} is {}, which woodcock does not read; {}", in.string(), foreign->what,
                     foreign->way);
}

}  // namespace

const std::vector<Format>& formats() {
    static const std::vector<Format> all = makeFormats();
    return all;
}

bool isPicture(const fs::path& file) {
    static constexpr std::string_view endings[]{".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg",
                                                ".bmp", ".tga", ".dpx",  ".hdr", ".pgm", ".webp"};
    const std::string extension = lowerExtension(file);
    return std::find(std::begin(endings), std::end(endings), extension) != std::end(endings);
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
            "'{}' is a folder. If it holds slices, name the files: {}. If it holds a DICOM series, "
            "load it into 3D Slicer and save it as .nrrd, or run `dcm2niix -e y {}`",
            in.string(), (in / "slice.####.png").string(), in.string());
    if (isPicture(in))
        throw inputError(
            "'{}' is one picture, and a volume needs several: name all of its slices, or their "
            "pattern, such as slice.####{}",
            in.string(), in.extension().string());
    throw inputError("the name of '{}' does not tell a known format; known: {} (--from names one)",
                     in.string(), listFormats(false));
}

const Format& outputFormat(const fs::path& out) {
    const Format* format = formatOfName(out);
    if (lowerExtension(out) == ".nhdr")
        throw usageError("cannot write '{}': header and values are written in one file, .nrrd",
                         out.string());
    if (format && format->written()) return *format;
    throw usageError("the name of '{}' does not tell a format that can be written; these can: {}",
                     out.string(), listFormats(true));
}

std::string describeFormats() {
    std::string text;
    for (const Format& format : formats()) {
        std::string extensions;
        for (const std::string& extension : format.extensions) extensions += " " + extension;
        text += fmt::format("  {:7} {}{}{}\n", format.name, format.what,
                            extensions.empty() ? "" : ":" + extensions,
                            format.written() ? " (read and written)" : " (read)");
    }
    return text;
}

}  // namespace woodcock::convert
