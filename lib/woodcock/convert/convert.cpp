// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/convert.h"

#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/convert/format_table.h"
#include "woodcock/convert/openvdb_convert_source.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::convert {

namespace fs = std::filesystem;

void say(const std::function<void(const std::string&)>& log, const std::string& text) {
    if (log && !text.empty()) log(text);
}

namespace {

/// "vdb, nvdb and npy": the names of the formats for which `holds` is true.
template <class Holds>
std::string namesWhere(Holds holds) {
    std::vector<std::string> names;
    for (const Format& format : formats())
        if (holds(format)) names.push_back(format.name);
    std::string text = names.front();
    for (std::size_t i = 1; i < names.size(); ++i)
        text += (i + 1 == names.size() ? " and " : ", ") + names[i];
    return text;
}

/// Refuses --compression and --precision where the output cannot have them.
void checkOutputOptions(const Format& to, const ConvertOptions& options) {
    if (to.writeGrids) return;
    if (options.compression && !to.dense.packs)
        throw usageError("--compression is for {}; {} files are not compressed",
                         namesWhere([](const Format& f) { return f.writeGrids || f.dense.packs; }),
                         to.name);
    if (options.compression == grid::VdbCompression::Blosc)
        throw usageError("--compression blosc: {} files take none or zip (gzip)", to.name);
    if (options.precision == Precision::Source) return;
    if (options.outputType)
        throw usageError("--precision and --out-type both say which numbers to write; give one");
    if (options.precision == Precision::Half && !to.dense.halves)
        throw usageError("--precision half: a {} file holds no halves; these do: {}", to.name,
                         namesWhere([](const Format& f) {
                             return f.writeGrids || (f.dense.write && f.dense.halves);
                         }));
    if (options.precision == Precision::Double &&
        to.dense.onlyType.value_or(SampleType::F64) != SampleType::F64)
        throw usageError("--precision double: a {} file holds only {}", to.name,
                         sampleTypeName(*to.dense.onlyType));
}

/// An option that the input would ignore is a mistake of the user.
void checkInputOptions(const Format& from, const ConvertOptions& options) {
    const InputOptions& takes = from.takes;
    if (!takes.layout && (options.dims || options.type || options.channels || options.bigEndian ||
                          options.headerBytes))
        throw usageError(
            "--dims, --type, --channels, --endian and --header are for raw files; the input is {} "
            "(--from raw reads it as numbers)",
            from.what);
    const auto refuse = [&](const char* option, bool given, bool InputOptions::*taken) {
        if (given && !(takes.*taken))
            throw usageError("{} is for these formats: {}; the input is {}", option,
                             namesWhere([&](const Format& f) { return f.takes.*taken; }),
                             from.what);
    };
    refuse("--grid", options.grid.has_value(), &InputOptions::grid);
    refuse("--band", options.band.has_value(), &InputOptions::band);
    refuse("--radius", options.radius.has_value(), &InputOptions::radius);
    refuse("--shell", options.shell, &InputOptions::shell);
    refuse("--columns", options.columns.has_value(), &InputOptions::columns);
}

void checkOptions(const Format& from, const Format& to, const ConvertOptions& options) {
    checkInputOptions(from, options);
    if (to.writeGrids && (options.outputType || options.bounds))
        throw usageError("--out-type and --bounds are for dense formats: {}; {} is a sparse one",
                         namesWhere([](const Format& f) { return f.dense.write; }), to.name);
    checkOutputOptions(to, options);
}

void write(const fs::path& in, const fs::path& out, Source& source, const Format& to,
           const ConvertOptions& options) {
    if (to.writeGrids)
        to.writeGrids(in, out, source.grids, options);
    else
        writeDenseSource(out, source, to.dense, options);
}

void requirePictures(const std::vector<fs::path>& in, const ConvertOptions& options) {
    if (options.from && *options.from != "images")
        throw usageError("--from {}: only pictures make one volume of several inputs",
                         *options.from);
    for (const fs::path& file : in)
        if (!options.from && !isPicture(file))
            throw usageError(
                "several inputs are slices of one volume, but '{}' is not a picture; convert other "
                "files one by one",
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
    Source source =
        sourceOf({readImageFiles(in, stageOf(options, "reading"))}, in.front(), options);
    write(in.front(), out, source, to, options);
}

}  // namespace woodcock::convert
