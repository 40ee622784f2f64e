// SPDX-License-Identifier: Apache-2.0
#include "tools/common/frames.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <new>

#include "tools/common/interrupt.h"
#include "tools/common/option_kinds.h"
#include "tools/common/render_command.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/frame_range.h"

namespace woodcock::tool {

namespace {

namespace fs = std::filesystem;

/// A command to copy that draws the frames of `pattern`.
std::string commandFor(const std::string& pattern, const std::vector<int>& frames) {
    const std::string picture = fs::path(pattern).filename().replace_extension(".png").string();
    return fmt::format("  woodcock render {} --frames {} -o {}", shellWord(pattern),
                       frameRangeText(frames), shellWord(picture));
}

/// The same for files whose names are no series.
std::string loopOver(const std::vector<fs::path>& files) {
    if (const auto series = seriesOf(files))
        if (const auto pattern = patternOf(*series)) {
            std::vector<int> frames;
            for (const std::string& number : series->numbers) frames.push_back(std::stoi(number));
            return commandFor(*pattern, frames);
        }
    std::string words;
    for (const fs::path& file : files) words += " " + shellWord(file.string());
    return fmt::format(
        "  woodcock render {} --write-scene shot.toml\n"
        "  for FILE in{}; do woodcock render shot.toml --set \"volume[0].file=$FILE\" -o "
        "\"$(basename \"$FILE\" .vdb).png\"; done",
        shellWord(files.back().string()), words);
}

/// "'a', 'b' and 'c'", or the first two of many and how many more.
std::string someOf(const std::vector<fs::path>& files) {
    std::string text = fmt::format("'{}'", files[0].string());
    if (files.size() == 2) return fmt::format("{} and '{}'", text, files[1].string());
    return fmt::format("{}, '{}' and {} more", text, files[1].string(), files.size() - 2);
}

Error sequence(const std::vector<fs::path>& frames) {
    return usageError(
        "{} differ only in a number: they look like frames of a sequence, and would all be drawn "
        "into one picture. Draw each into its own:\n{}\nIf they belong into one picture, give "
        "--overlay",
        someOf(frames), loopOver(frames));
}

constexpr const char* knownPatterns = "####, %04d, $F4 or <frame04>";

Error unfilled(const std::string& name, const std::string& pattern) {
    if (!namesFrame(name))
        return usageError(
            "there is no file '{}': '{}' is not filled in. Put {} where a frame's number goes, and "
            "say which frames by --frames 1-48",
            name, pattern, knownPatterns);
    const std::vector<int> frames = framesOnDisk(name);
    if (frames.empty())
        return usageError(
            "there is no file '{}': '{}' stands for a frame's number, and no file has a number in "
            "its place",
            name, pattern);
    return usageError(
        "there is no file '{}': '{}' stands for a frame's number. Say which frames to draw:\n{}",
        name, pattern, commandFor(name, frames));
}

Error folder(const fs::path& directory) {
    std::vector<fs::path> volumes;
    std::error_code none;
    for (fs::directory_iterator file(directory, none), end; !none && file != end;
         file.increment(none))
        if (file->path().extension() == ".vdb") volumes.push_back(file->path());
    std::sort(volumes.begin(), volumes.end());
    const std::string is = fmt::format(
        "'{}' is a directory; name a scene (.toml) or a volume (.vdb)", directory.string());
    if (volumes.empty()) return inputError("{}; it holds no .vdb file", is);
    const std::vector<fs::path> frames = framesAmong(volumes);
    if (frames.size() == volumes.size())
        return usageError("{}. It holds {} frames; draw each into its own picture:\n{}", is,
                          frames.size(), loopOver(frames));
    return usageError("{}; it holds {} .vdb file{}, such as '{}'", is, volumes.size(),
                      volumes.size() == 1 ? "" : "s", volumes.front().string());
}

std::string withPattern(const fs::path& file) {
    return (file.parent_path() / (file.stem().string() + ".####")).string() +
           file.extension().string();
}

}  // namespace

CLI::Option* addFrames(CLI::App& command, std::vector<int>& frames, const std::string& help) {
    return addParsed(command, "--frames", frames, parseFrameRange, help)->type_name("RANGE");
}

CLI::Option* addSkipExisting(CLI::App& command, bool& skip) {
    return command.add_flag("--skip-existing", skip,
                            "Leave out frames whose files are all there already");
}

void checkNoFrames(const std::vector<fs::path>& inputs, bool overlay, bool withFrames) {
    std::error_code none;
    for (const fs::path& input : inputs) {
        const std::string name = input.string(), pattern = framePattern(name);
        if (!pattern.empty() && !fs::exists(input, none) && !(withFrames && namesFrame(name)))
            throw unfilled(name, pattern);
        if (fs::is_directory(input, none)) throw folder(input);
    }
    if (overlay) return;
    if (const std::vector<fs::path> frames = framesAmong(inputs); !frames.empty())
        throw sequence(frames);
}

void checkFrameInputs(const std::vector<fs::path>& inputs) {
    if (inputs.empty() || std::any_of(inputs.begin(), inputs.end(), [](const fs::path& input) {
            return namesFrame(input.string());
        }))
        return;
    const FrameSeries series = seriesAround(inputs.front());
    const auto pattern = series.numbers.size() > 1 ? patternOf(series) : std::nullopt;
    throw usageError(
        "--frames: '{}' would be read for every frame; put {} where a frame's number goes, such as "
        "'{}'",
        inputs.front().string(), knownPatterns, pattern ? *pattern : withPattern(inputs.front()));
}

void checkFrameOutput(const fs::path& output, const std::string& place,
                      const std::vector<int>& frames) {
    const std::string name = output.string(), where = place.empty() ? "" : place + ": ";
    const std::string unfilled = framePattern(withFrame(name, 1));
    if (!unfilled.empty())
        throw usageError(
            "{}'{}': {} is not filled in, and the file would be called so; put {} where a frame's "
            "number goes",
            where, name, unfilled, knownPatterns);
    if (frames.empty() && namesFrame(name))
        throw usageError(
            "{}'{}': {} stands for a frame's number, and no frames are asked for; say which, by "
            "--frames 1-48, or name one file",
            where, name, framePattern(name));
    if (!frames.empty() && !namesFrame(name))
        throw usageError(
            "{}'{}': there {} and one file; put {} where a frame's number goes, such as '{}'",
            where, name,
            frames.size() == 1 ? "is --frames" : fmt::format("are {} frames", frames.size()),
            knownPatterns, withPattern(output));
}

void checkNoPattern(const fs::path& output, const std::string& place) {
    const std::string pattern = framePattern(output.string());
    if (pattern.empty()) return;
    throw usageError("{}'{}': {} is not filled in, and the file would be called so; name one file",
                     place.empty() ? "" : place + ": ", output.string(), pattern);
}

fs::path inFrame(const fs::path& file, int frame) { return withFrame(file.string(), frame); }

bool allExist(const std::vector<fs::path>& files) {
    std::error_code none;
    return !files.empty() && std::all_of(files.begin(), files.end(), [&](const fs::path& file) {
        return fs::exists(file, none);
    });
}

FrameReport forEachFrame(const std::vector<int>& frames,
                         const std::function<ExitCode(int frame)>& work) {
    FrameReport report;
    std::string told;
    const auto tell = [&](int frame, const std::string& error) {
        spdlog::error("frame {}: {}", frame, error == told ? "the same" : error);
        told = error;
    };
    for (const int frame : frames) {
        if (interrupted()) report.interrupted = true;
        if (report.interrupted) break;
        ExitCode code = exitFailed;
        try {
            code = work(frame);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::Usage && frame == frames.front()) throw;
            tell(frame, error.what());
            code = exitCodeOf(error.kind());
        } catch (const CLI::RuntimeError& end) {  // of endIfInterrupted()
            if (end.get_exit_code() != exitInterrupted) throw;
            code = exitInterrupted;
        } catch (const std::bad_alloc&) {
            tell(frame, "out of memory");
        }
        if (code == exitInterrupted) {
            report.interrupted = true;
        } else if (code == exitDone) {
            report.done.push_back(frame);
        } else {
            report.failed.push_back(frame);
            report.code = code;
        }
    }
    return report;
}

void endUnlessDone(const FrameReport& report) {
    const std::size_t all = report.done.size() + report.failed.size();
    if (!report.failed.empty() && all > 1)
        spdlog::error("{} of {} frames failed: {}", report.failed.size(), all,
                      frameRangeText(report.failed));
    if (report.interrupted) {
        if (report.done.empty())
            spdlog::warn("interrupted: no frame is done");
        else
            spdlog::warn("interrupted: {} frame{} done: {}", report.done.size(),
                         report.done.size() == 1 ? " is" : "s are", frameRangeText(report.done));
        endWith(exitInterrupted);
    }
    if (!report.failed.empty())
        endWith(all == 1 && report.code != exitDone ? report.code : exitFailed);
}

}  // namespace woodcock::tool
