// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/frames.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/output_folders.h"
#include "tools/common/print.h"
#include "tools/common/report_options.h"
#include "tools/compare/against_cycles.h"
#include "tools/compare/report.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool {

namespace {

// ---- limits

/// A number for a whole image that is 0 where it equals the reference.
struct Metric {
    std::string name;
    std::function<double(const compare::ImageComparison&)> value;
};

/// The largest over channels.
std::function<double(const compare::ImageComparison&)> worst(
    double (*of)(const compare::ChannelComparison&)) {
    return [of](const compare::ImageComparison& image) {
        double most = 0;
        for (const compare::ChannelComparison& c : image.channels) {
            const double v = of(c);
            // A ratio to a mean of 0 is beyond any limit.
            most = std::isnan(v) ? std::numeric_limits<double>::infinity() : std::max(most, v);
        }
        return most;
    };
}

const std::vector<Metric>& metrics() {
    using C = compare::ChannelComparison;
    static const std::vector<Metric> all{
        {"bias", worst([](const C& c) { return std::abs(c.bias.value); })},
        {"ratio", worst([](const C& c) {
             return c.metrics.meanA == c.metrics.meanB ? 0 : std::abs(c.ratio - 1);
         })},
        {"rmse", worst([](const C& c) { return c.metrics.rmse; })},
        {"relmse", worst([](const C& c) { return c.metrics.relMse; })},
        {"largest", worst([](const C& c) {
             const auto& l = c.metrics.largest;
             return l.empty() ? 0 : std::abs(l.front().b - l.front().a);
         })},
        {"flip", [](const compare::ImageComparison& i) { return i.flip ? i.flip->ldr : 0; }},
        {"hdr-flip", [](const compare::ImageComparison& i) { return i.flip ? i.flip->hdr : 0; }},
        {"non-finite", worst([](const C& c) {
             return static_cast<double>(c.metrics.nonFiniteA + c.metrics.nonFiniteB);
         })},
        {"tiles",
         [](const compare::ImageComparison& i) { return static_cast<double>(i.differentTiles); }}};
    return all;
}

struct Limit {
    const Metric* metric = nullptr;  ///< none: the verdict
    double value = 0;
};

Limit parseLimit(const std::string& text) {
    if (text == "differ") return {};
    std::vector<std::string> names{"differ"};
    const std::string name = text.substr(0, text.find('='));
    for (const Metric& metric : metrics()) {
        names.push_back(metric.name);
        if (metric.name != name) continue;
        if (name == text)
            throw usageError("--fail-above: {} needs a value, as in {}=0.01", name, name);
        try {
            return {&metric, parseNumber(text.substr(name.size() + 1), 0, 1e300)};
        } catch (const Error& error) {
            throw usageError("--fail-above: {}: {}", name, error.what());
        }
    }
    throw usageError("--fail-above: unknown metric '{}'{}", name,
                     suggestName(name, "known", names));
}

/// Says which limits are exceeded.
bool exceeds(const compare::Comparison& comparison, const std::vector<std::string>& limits) {
    bool any = false;
    for (const std::string& text : limits) {
        const Limit limit = parseLimit(text);
        for (const compare::ImageComparison& image : comparison.images) {
            const std::string& letter = comparison.pictures[image.image].letter;
            const double value = limit.metric ? limit.metric->value(image) : image.differ;
            if (value <= limit.value) continue;
            any = true;
            if (limit.metric)
                spdlog::error("{} of {} is {:.6g}, above {:g}", limit.metric->name, letter, value,
                              limit.value);
            else
                spdlog::error("{} differs: {}", letter, image.reason);
        }
    }
    return any;
}

// ---- options

struct CompareOptions {
    std::vector<compare::PictureSource> sources;
    compare::CompareSettings settings;
    std::vector<std::string> failAbove;  ///< "rmse=0.01", "differ"
    std::filesystem::path report;        ///< a directory; empty: none
    std::filesystem::path ocio;          ///< empty: $OCIO or the shipped one
    std::vector<int> frames;             ///< empty: no sequence
    ReportOptions reports;
};

const std::vector<std::string> reportFiles{"compare.json", "compare.html"};

/// "B=word" to the image of that letter.
std::pair<compare::PictureSource*, std::string> forImage(
    std::vector<compare::PictureSource>& sources, const char* option, const std::string& text) {
    const std::size_t index = text.size() > 2 && text[1] == '=' && text[0] >= 'A'
                                  ? static_cast<std::size_t>(text[0] - 'A')
                                  : sources.size();
    if (index >= sources.size())
        throw usageError("{}: '{}' does not begin with an image's letter and '=': images are {}",
                         option, text,
                         sources.size() < 2
                             ? "A, B, ..."
                             : fmt::format("A to {}", static_cast<char>('A' + sources.size() - 1)));
    return {&sources[index], text.substr(2)};
}

/// What the command line says, before it is sorted by image.
struct CompareWords {
    std::vector<std::string> files, more, colourSpaces;
    CompareOptions options;
    std::filesystem::path scene;  ///< of --cycles
    BothOptions cycles;

    /// The options of --cycles that were given beside files.
    void check() const {
        const bool both = !scene.empty();
        if (!both && files.empty())
            throw usageError(
                "there is nothing to compare; name two images or more, or a scene after --cycles");
        if (both && !(files.empty() && more.empty() && colourSpaces.empty()))
            throw usageError(
                "--cycles renders both images itself; give images or --cycles, not both");
        if (both && !options.frames.empty())
            throw usageError("--frames is for images, and --cycles renders one frame");
        if (!both &&
            (cycles.spp || cycles.seeds || cycles.mode || cycles.interpolation || cycles.stepRate ||
             !cycles.blender.empty() || !cycles.input.overrides.empty()))
            throw usageError(
                "--spp, --seeds, --mode, --step-rate, --interpolation, --blender and --set belong "
                "to --cycles");
    }

    CompareOptions sorted() const {
        CompareOptions o = options;
        for (const std::string& file : files) o.sources.push_back({file, {}, {}});
        for (const std::string& word : more) {
            const auto [source, file] = forImage(o.sources, "--more", word);
            source->more.push_back(file);
        }
        for (const std::string& word : colourSpaces) {
            const auto [source, space] = forImage(o.sources, "--colour-space", word);
            source->colourSpace = space;
        }
        return o;
    }
};

void refuseOverwritingInputs(const CompareOptions& o) {
    if (o.report.empty()) return;
    std::vector<std::filesystem::path> read{o.ocio}, written;
    for (const compare::PictureSource& source : o.sources) {
        read.push_back(source.file);
        read.insert(read.end(), source.more.begin(), source.more.end());
    }
    for (const std::string& name : reportFiles) written.push_back(o.report / name);
    refuseOverwriting(written, read);
}

/// Compares, prints and writes the report. Notes go to the log. exitFailed where `failAbove` says
/// so. With `json`, what --json prints goes there.
ExitCode runCompare(const CompareOptions& o, std::string* json = nullptr) {
    for (const std::string& limit : o.failAbove) parseLimit(limit);
    const image::ColorConfig config(o.ocio);
    compare::LoadedPictures loaded = compare::loadPictures(o.sources, o.settings.resample, config);
    refuseOverwritingInputs(o);
    prepareReport(o.report, reportFiles);  // images that cannot be compared leave no directory
    const compare::Comparison comparison = compare::compare(std::move(loaded), o.settings);
    if (!o.report.empty() && !config.note().empty()) spdlog::warn("{}", config.note());
    for (const std::string& note : comparison.notes) spdlog::warn("{}", note);
    if (json)
        *json = compareJson(comparison);
    else if (o.reports.json)
        printData(compareJson(comparison));
    if (!o.reports.json && o.reports.printsText()) printText(compareText(comparison));
    std::fflush(stdout);
    if (!o.report.empty())
        writeReport(o.report, {{reportFiles[0], compareJson(comparison)},
                               {reportFiles[1], compareHtml(comparison, bakeViews(config))}});
    return exceeds(comparison, o.failAbove) ? exitFailed : exitDone;
}

/// The same in a frame.
CompareOptions optionsIn(const CompareOptions& options, int frame) {
    CompareOptions o = options;
    for (compare::PictureSource& source : o.sources) {
        source.file = inFrame(source.file, frame);
        for (std::filesystem::path& more : source.more) more = inFrame(more, frame);
    }
    o.report = inFrame(o.report, frame);
    return o;
}

void runFrames(const CompareOptions& options) {
    std::vector<std::filesystem::path> files;
    for (const compare::PictureSource& source : options.sources) files.push_back(source.file);
    checkFrameInputs(files);
    if (!options.report.empty()) checkFrameOutput(options.report, "--report", options.frames);
    using Json = nlohmann::ordered_json;
    Json all = Json::array();
    const FrameReport report = forEachFrame(options.frames, [&](int frame) {
        const CompareOptions o = optionsIn(options, frame);
        if (o.reports.printsText()) print("frame {}\n", frame);
        std::string json;
        const ExitCode code = runCompare(o, o.reports.json ? &json : nullptr);
        if (o.reports.json) {
            Json ofFrame{{"frame", frame}};
            ofFrame.update(Json::parse(json));
            all.push_back(std::move(ofFrame));
        }
        return code;
    });
    if (options.reports.json) printJson(Json{{"frames", all}, {"failed", report.failed}});
    endUnlessDone(report);
}

ExitCode run(const CompareWords& words, const std::string& commandLine) {
    const ProgressStyle style = words.options.reports.start();
    words.check();
    CompareOptions o = words.sorted();
    if (words.scene.empty()) {
        if (o.frames.empty()) return runCompare(o);
        catchInterrupts();
        runFrames(o);
        return exitDone;
    }
    BothOptions both = words.cycles;
    both.input.files = {words.scene};
    for (const std::string& limit : o.failAbove) parseLimit(limit);
    if (!o.report.empty()) {
        prepareReport(o.report, reportFiles);
        o.sources = renderBoth(both, o.report, commandLine, style);
        return runCompare(o);
    }
    const TempDir scratch;
    o.sources = renderBoth(both, scratch.path(), commandLine, style);
    return runCompare(o);
}

/// What belongs to --cycles.
void addCyclesOptions(CLI::App& command, BothOptions& cycles) {
    addCount(command, "--spp", cycles.spp, 1, 16777216,
             "For --cycles: samples per pixel of each seed (the scene's)");
    addCount(command, "--seeds", cycles.seeds, 2, 64,
             "For --cycles: renders by each program. Their scatter gives the error (2)");
    addChoice(command, "--mode", cycles.mode, {"null", "biased"},
              "For --cycles: how Cycles samples volumes, by null-collision tracking or biased ray "
              "marching:")
        ->type_name("MODE");
    addChoice(command, "--interpolation", cycles.interpolation, {"stochastic", "trilinear"},
              "For --cycles: how Cycles reads grids:")
        ->type_name("KIND");
    addParsed(
        command, "--step-rate", cycles.stepRate,
        [](const std::string& text) { return parseNumber(text, 1e-3, 100); },
        "For --cycles --mode biased: length of a step, as in Blender's step rate")
        ->type_name("NUMBER");
    command
        .add_option("--blender", cycles.blender,
                    "For --cycles: Blender's program, or a Python with bpy. Without it: $BLENDER, "
                    "then blender on the PATH")
        ->type_name("PROGRAM");
    addList(command, "--set", cycles.input.overrides,
            "For --cycles: set a value of the scene, such as volume[0].scale=2")
        ->type_name("KEY=VALUE");
}

CLI::App& addTo(CLI::App& app, const std::string& commandLine) {
    CLI::App* command =
        app.add_subcommand("compare",
                           "Compare images with a reference: metrics, tests whether they differ by "
                           "more than noise, and a page to look at");
    auto words = std::make_shared<CompareWords>();
    CompareOptions& o = words->options;
    command
        ->add_option("INPUT", words->files,
                     "Images (EXR, PNG, JPEG, TIFF, HDR ...). The first is the reference A, the "
                     "others are B, C, ...")
        ->type_name("FILE");
    command
        ->add_option(
            "--cycles", words->scene,
            "Instead of images: render this scene (.toml or .vdb) by Woodcock (A) and by Blender's "
            "Cycles (B), and compare both. The images stay in the folder of --report")
        ->type_name("SCENE");
    addCyclesOptions(*command, words->cycles);
    addList(*command, "--more", words->more,
            "Another render of an image with another seed, as in A=second.exr. The mean is "
            "compared. The scatter gives the error where the files have no layer 'error'")
        ->type_name("LETTER=FILE");
    command
        ->add_option(
            "--report", o.report,
            "Write DIR/compare.json and DIR/compare.html, a page that you can open anywhere")
        ->type_name("DIR");
    addFrames(*command, o.frames,
              "Compare these frames, such as 1-48 or 1-48x2,60. Their numbers replace the #### (or "
              "%04d, $F4, <frame04>) in the names of images and of the report's folder");
    o.reports.addTo(*command, "Print one JSON document on stdout instead of the tables");
    addList(*command, "--fail-above", o.failAbove,
            "Exit with code 1 if a metric of an image is above VALUE. Metrics: bias, ratio (its "
            "distance from 1), rmse, relmse, largest, flip, hdr-flip, non-finite, tiles (how many "
            "differ). The word 'differ' alone stands for the verdict")
        ->type_name("METRIC=VALUE");
    command->add_flag("--resample", o.settings.resample,
                      "Bring images of different sizes to the smallest width and height, by "
                      "averaging over areas");
    addParsed(
        *command, "--tile", o.settings.tile,
        [](const std::string& text) { return static_cast<int>(parseCount(text, 2, 4096)); },
        "Smallest side of a tile in pixels (8)")
        ->type_name("PIXELS");
    addParsed(
        *command, "--false-alarms", o.settings.falseAlarms,
        [](const std::string& text) { return parseNumber(text, 1e-12, 0.5); },
        "How likely a wrong verdict 'differ' may be where only noise differs, over all tiles and "
        "channels together (0.001)")
        ->type_name("RATE");
    addList(*command, "--colour-space", words->colourSpaces,
            "Colour space of an image, as in B=ACEScg, by its name in the OpenColorIO config. "
            "Without it: scene-linear for floats, sRGB for integers")
        ->type_name("LETTER=NAME");
    command
        ->add_option(
            "--ocio", o.ocio,
            "OpenColorIO config. Without it: that of $OCIO, then the one that comes with Woodcock")
        ->type_name("FILE");
    command->footer(
        examplesText({"woodcock compare reference.exr test.exr --report comparison",
                      "woodcock compare reference.png test.png --quiet --fail-above flip=0.05",
                      "woodcock compare old.####.exr new.####.exr --frames 1-48"}));
    command->callback([words, commandLine] {
        if (const ExitCode code = run(*words, commandLine); code != exitDone) endWith(code);
    });
    return *command;
}

}  // namespace

extern const Command compareCommand{&addTo};

}  // namespace woodcock::tool
