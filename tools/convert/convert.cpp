// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/frames.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/progress.h"
#include "tools/common/report_options.h"
#include "tools/info/report.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/base/parse.h"
#include "woodcock/convert/convert.h"

namespace woodcock::tool {

namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// What the command line says, as it is written.
struct ConvertWords {
    std::vector<std::filesystem::path> files;  ///< inputs, then the output
    std::optional<std::string> from, grid, name, dims, type, channels, endian, header, channel,
        axes, voxel, size, origin, scale, offset, clamp, threshold, tolerance, precision,
        compression, outType, bounds, band, radius, columns;
    bool repair = false, shell = false, mkdir = false, skipExisting = false;
    std::vector<int> frames;
    ReportOptions reports;
};

/// "1,2,3": exactly `count` numbers.
std::vector<double> numbers(std::string_view text, std::size_t count, const char* example) {
    std::vector<double> values;
    for (std::string_view rest = text; values.size() < count;) {
        const std::size_t comma = values.size() + 1 < count ? rest.find(',') : rest.size();
        double value = 0;
        const char* const end = rest.data() + std::min(comma, rest.size());
        const auto [stop, error] = std::from_chars(rest.data(), end, value);
        if (comma == rest.npos || error != std::errc() || stop != end || !std::isfinite(value))
            throw usageError("'{}' is not {} numbers such as {}", text, count, example);
        values.push_back(value);
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return values;
}

std::vector<std::int64_t> wholeNumbers(std::string_view text, std::size_t count,
                                       const char* example) {
    std::vector<std::int64_t> whole;
    for (const double value : numbers(text, count, example)) {
        if (value != std::floor(value) || std::abs(value) > double(convert::mostVoxelsOfSide))
            throw usageError("'{}' is not {} whole numbers such as {}", text, count, example);
        whole.push_back(static_cast<std::int64_t>(value));
    }
    return whole;
}

/// Calls `use` with the option's text, so that a mistake in it names the option.
template <class Use>
void ifGiven(const char* option, const std::optional<std::string>& text, Use use) {
    if (!text) return;
    try {
        use(*text);
    } catch (const Error& e) {
        throw Error(e.kind(), fmt::format("{}: {}", option, e.what()));
    }
}

convert::Dims parseDims(const std::string& text) {
    const auto n = wholeNumbers(text, 3, "64,64,32");
    if (n[0] < 1 || n[1] < 1 || n[2] < 1) throw usageError("'{}' has a side below 1", text);
    return {n[0], n[1], n[2]};
}

Box3i parseBounds(const std::string& text) {
    const auto n = wholeNumbers(text, 6, "0,0,0,63,63,31");
    const auto corner = [&](std::size_t i) {
        return Vec3i{static_cast<int>(n[i]), static_cast<int>(n[i + 1]),
                     static_cast<int>(n[i + 2])};
    };
    const Box3i box{corner(0), corner(3)};
    if (box.empty()) throw usageError("'{}' is empty: the first corner is beyond the last", text);
    return box;
}

template <class T>
T oneOf(const std::string& text, std::initializer_list<std::pair<const char*, T>> known) {
    std::string names;
    for (const auto& [name, value] : known) {
        if (text == name) return value;
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
    throw usageError("'{}' is not one of {}", text, names);
}

/// "0.1", or "0.1,0.1,0.5".
void readSides(const std::string& text, std::optional<double>& one, std::optional<Vec3d>& each) {
    constexpr double least = 1e-30, most = 1e30;
    if (text.find(',') == text.npos) {
        one = parseNumber(text, least, most);
        return;
    }
    const auto sides = numbers(text, 3, "0.1,0.1,0.5");
    for (const double side : sides)
        if (!(side >= least && side <= most))
            throw usageError("'{}' has a side that is not between {} and {}", text, least, most);
    each = Vec3d{sides[0], sides[1], sides[2]};
}

void readValueWords(const ConvertWords& words, convert::ValueOptions& values) {
    const auto number = [](double& to) {
        return [&to](const std::string& t) { to = parseNumber(t, -largest, largest); };
    };
    ifGiven("--scale", words.scale, number(values.remap.scale));
    ifGiven("--offset", words.offset, number(values.remap.offset));
    ifGiven("--threshold", words.threshold, number(values.remap.threshold));
    ifGiven("--clamp", words.clamp, [&](const std::string& t) {
        const auto ends = numbers(t, 2, "0,1");
        if (ends[0] > ends[1]) throw usageError("'{}' has its low end above its high end", t);
        values.remap.low = ends[0];
        values.remap.high = ends[1];
    });
    ifGiven("--tolerance", words.tolerance,
            [&](const std::string& t) { values.tolerance = parseNumber(t, 0, largest); });
    values.repair = words.repair;
}

convert::ConvertOptions readWords(const ConvertWords& words) {
    convert::ConvertOptions options;
    options.from = words.from;
    options.grid = words.grid;
    options.name = words.name;
    ifGiven("--dims", words.dims, [&](const std::string& t) { options.dims = parseDims(t); });
    ifGiven("--type", words.type,
            [&](const std::string& t) { options.type = convert::sampleTypeFromName(t); });
    ifGiven("--channels", words.channels, [&](const std::string& t) {
        options.channels = static_cast<int>(parseCount(t, 1, 1024));
    });
    ifGiven("--endian", words.endian, [&](const std::string& t) {
        options.bigEndian = oneOf<bool>(t, {{"little", false}, {"big", true}});
    });
    ifGiven("--header", words.header, [&](const std::string& t) {
        options.headerBytes = parseCount(t, 0, std::numeric_limits<std::int64_t>::max());
    });
    ifGiven("--channel", words.channel, [&](const std::string& t) {
        options.channel = static_cast<int>(parseCount(t, 0, 1023));
    });
    ifGiven("--axes", words.axes,
            [&](const std::string& t) { options.axes = convert::parseAxisOrder(t); });
    convert::Placement& placement = options.placement;
    ifGiven("--voxel", words.voxel,
            [&](const std::string& t) { readSides(t, placement.voxel, placement.voxelSides); });
    ifGiven("--size", words.size,
            [&](const std::string& t) { readSides(t, placement.size, placement.sizeSides); });
    const auto length = [](std::optional<double>& to) {
        return [&to](const std::string& t) { to = parseNumber(t, 1e-30, 1e30); };
    };
    ifGiven("--band", words.band, length(options.band));
    ifGiven("--radius", words.radius, length(options.radius));
    options.shell = words.shell;
    options.columns = words.columns;
    ifGiven("--origin", words.origin, [&](const std::string& t) {
        const auto p = numbers(t, 3, "0,0.5,0");
        options.placement.origin = Vec3d{p[0], p[1], p[2]};
    });
    if (words.voxel && words.size)
        throw usageError("--voxel and --size both say how large the volume is; give one");
    readValueWords(words, options.values);
    ifGiven("--precision", words.precision, [&](const std::string& t) {
        options.precision = oneOf<convert::Precision>(t, {{"half", convert::Precision::Half},
                                                          {"float", convert::Precision::Float},
                                                          {"double", convert::Precision::Double}});
    });
    ifGiven("--compression", words.compression, [&](const std::string& t) {
        options.compression =
            oneOf<grid::VdbCompression>(t, {{"none", grid::VdbCompression::None},
                                            {"zip", grid::VdbCompression::Zip},
                                            {"blosc", grid::VdbCompression::Blosc}});
    });
    ifGiven("--out-type", words.outType,
            [&](const std::string& t) { options.outputType = convert::sampleTypeFromName(t); });
    ifGiven("--bounds", words.bounds,
            [&](const std::string& t) { options.bounds = parseBounds(t); });
    return options;
}

/// The progress of one stage after the other.
class Stages {
public:
    explicit Stages(ProgressStyle style) : style_(style) {}

    void show(std::string_view stage, double fraction) {
        if (!now_ || stage != stage_) {
            stage_ = stage;
            now_.emplace(style_, stage_);
        }
        now_->update(fraction);
    }
    void clear() { now_.reset(); }

private:
    ProgressStyle style_;
    std::string stage_;
    std::optional<ProgressBar> now_;
};

using Json = nlohmann::ordered_json;
using Files = std::vector<std::filesystem::path>;

/// What was read and written. `files`: inputs, then the output.
Json resultJson(const Files& files, const std::vector<std::string>& notes,
                const std::vector<std::string>& warnings, double seconds) {
    const std::filesystem::path& out = files.back();
    std::vector<std::string> inputs;
    for (const std::filesystem::path& file : files) inputs.push_back(file.string());
    inputs.pop_back();
    Json result{{"inputs", inputs}, {"output", out.string()}};
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(out, unknown);
    result["bytes"] = unknown ? Json() : Json(bytes);
    result.update({{"seconds", seconds}, {"notes", notes}, {"warnings", warnings}});
    if (out.extension() == ".vdb")
        result["grids"] = infoJson({inspectFile(out, "")})["files"][0]["grids"];
    return result;
}

/// What --json says; null without it.
Json convertFiles(const Files& files, const ConvertWords& words, ProgressStyle style) {
    convert::ConvertOptions options = readWords(words);
    Stages bar(style);
    std::vector<std::string> notes, warnings;
    options.info = [&](const std::string& text) {
        endIfInterrupted();
        bar.clear();
        spdlog::info("{}", text);
        notes.push_back(text);
    };
    options.warn = [&](const std::string& text) {
        bar.clear();
        spdlog::warn("{}", text);
        warnings.push_back(text);
    };
    options.progress = [&](std::string_view stage, double fraction) {
        endIfInterrupted();
        bar.show(stage, fraction);
    };
    prepareFolder(files.back(), words.mkdir);
    const auto start = std::chrono::steady_clock::now();
    convert::convert(Files(files.begin(), files.end() - 1), files.back(), options);
    if (!words.reports.json) return {};
    bar.clear();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    return resultJson(files, notes, warnings, time.count());
}

void convertFrames(const ConvertWords& words, ProgressStyle style) {
    checkFrameInputs(Files(words.files.begin(), words.files.end() - 1));
    Json all = Json::array();
    std::vector<int> skipped;
    const FrameReport report = forEachFrame(words.frames, [&](int frame) {
        Files files;
        for (const std::filesystem::path& file : words.files) files.push_back(inFrame(file, frame));
        if (words.skipExisting && allExist({files.back()})) {
            skipped.push_back(frame);
            return exitDone;
        }
        spdlog::info("frame {}", frame);
        Json ofFrame{{"frame", frame}};
        if (const Json result = convertFiles(files, words, style); !result.is_null())
            ofFrame.update(result);
        all.push_back(std::move(ofFrame));
        return exitDone;
    });
    if (!skipped.empty())
        spdlog::info("frame{} {}: there already", skipped.size() == 1 ? "" : "s",
                     frameRangeText(skipped));
    if (words.reports.json)
        printJson(Json{{"frames", all}, {"failed", report.failed}, {"skipped", skipped}});
    endUnlessDone(report);
}

void run(const ConvertWords& words) {
    const ProgressStyle style = words.reports.start();
    catchInterrupts();
    readWords(words);
    if (words.files.size() < 2)
        throw usageError("'{}' is given alone: name an input and an output",
                         words.files.empty() ? "" : words.files.front().string());
    checkFrameOutput(words.files.back(), "", words.frames);
    if (!words.frames.empty()) return convertFrames(words, style);
    if (words.skipExisting && allExist({words.files.back()}))
        return spdlog::info("{} is there already: nothing to do", words.files.back().string());
    const Json result = convertFiles(words.files, words, style);
    if (words.reports.json) printJson(result);
}

CLI::App& addTo(CLI::App& app, const std::string&) {
    CLI::App& command = *app.add_subcommand(
        "convert", "Convert volumes and shapes of other formats to VDB, and VDB to other formats");
    const auto words = std::make_shared<ConvertWords>();
    command
        .add_option(
            "INPUT... OUTPUT", words->files,
            "What to convert, then the file to write. Name slices as slice.####.png, or one by one")
        ->required()
        ->type_name("FILE");
    addMkdir(command, words->mkdir);
    addFrames(command, words->frames,
              "Convert these frames, such as 1-48 or 1-48x2,60. Their numbers replace the #### (or "
              "%04d, $F4, <frame04>) in the names of inputs and output");
    addSkipExisting(command, words->skipExisting);
    const auto add = [&](const char* group, const char* name, std::optional<std::string>& to,
                         const char* type, const char* help) {
        command.add_option(name, to, help)->type_name(type)->group(group);
    };
    add("Input", "--from", words->from, "FORMAT",
        "Format of INPUT, where its name does not say it");
    add("Input", "--grid", words->grid, "NAME",
        "Which to take: a grid of a VDB, a medium of a pbrt scene, or an array of a .npz");
    add("Input", "--channel", words->channel, "N", "Take this channel only, counted from 0");
    add("Bare numbers", "--dims", words->dims, "X,Y,Z",
        "Voxels along each axis. x varies fastest in the file");
    add("Bare numbers", "--type", words->type, "TYPE",
        "Type of the numbers: u8, i8, u16, i16, u32, i32, u64, i64, f16, f32 or f64");
    add("Bare numbers", "--channels", words->channels, "N", "How many numbers each voxel has (1)");
    add("Bare numbers", "--endian", words->endian, "ORDER",
        "Order of the bytes of a number: little (usual) or big");
    add("Bare numbers", "--header", words->header, "BYTES",
        "How many bytes stand before the numbers (0)");
    add("Shapes", "--band", words->band, "WIDTH",
        "Depth below the surface of a mesh or level set where density reaches one (three voxels)");
    add("Shapes", "--radius", words->radius, "R",
        "Radius of points that have none of their own (2 voxels)");
    add("Shapes", "--columns", words->columns, "NAMES",
        "What the columns of a table of points are, such as x,y,z,-,radius. - skips a column");
    command
        .add_flag("--shell", words->shell, "Make fog around a mesh's surface instead of inside it")
        ->group("Shapes");
    add("Place", "--axes", words->axes, "ORDER",
        "Axes of the source that become x, y and z, such as xzy or x,-z,y. A minus reverses an "
        "axis");
    add("Place", "--voxel", words->voxel, "SIZE",
        "Side of a voxel, or its three sides X,Y,Z. One number is the shortest side of unequal "
        "ones");
    add("Place", "--size", words->size, "LENGTH",
        "Longest side of the volume, or its three sides, instead of --voxel");
    add("Place", "--origin", words->origin, "X,Y,Z", "Centre of the first voxel");
    constexpr const char* values = "Values, in this order: repair, scale, offset, clamp, threshold";
    command.add_flag("--repair", words->repair, "Set NaN and infinite values to zero")
        ->group(values);
    add(values, "--scale", words->scale, "S", "Multiply");
    add(values, "--offset", words->offset, "B", "Then add");
    add(values, "--clamp", words->clamp, "LOW,HIGH", "Then clamp");
    add(values, "--threshold", words->threshold, "T", "Then set to zero what is below");
    add(values, "--tolerance", words->tolerance, "E",
        "Turn values this near to zero into background, which takes no memory (0)");
    add("Output", "--name", words->name, "NAME", "Name of the grid (density)");
    add("Output", "--precision", words->precision, "P",
        "Save values as half, float or double. The largest error is printed");
    add("Output", "--compression", words->compression, "C",
        "How to compress: none, zip or blosc. Without it: blosc for vdb, none for nvdb and nrrd");
    add("Output", "--out-type", words->outType, "TYPE", "Type of the numbers in a dense file");
    add("Output", "--bounds", words->bounds, "X0,Y0,Z0,X1,Y1,Z1",
        "First and last voxel of a dense file. Without it: the box of the active voxels");
    words->reports.addTo(command, "Print a JSON object about what is written, on stdout");
    command.footer("Formats:\n" + convert::describeFormats() + "\n" +
                   examplesText({"woodcock convert teapot.obj teapot.vdb --voxel 0.01",
                                 "woodcock convert slice.####.png scan.vdb --voxel 0.5",
                                 "woodcock convert fire.####.vdb fire.####.nvdb --frames 1-48"}));
    command.callback([words] { run(*words); });
    return command;
}

}  // namespace

extern const Command convertCommand{&addTo};

}  // namespace woodcock::tool
