// SPDX-License-Identifier: Apache-2.0
#include "tools/common/frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/common/render_command.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"

namespace woodcock::tool {

namespace {

namespace fs = std::filesystem;

/// Inside a shell's double quotes.
std::string inQuotes(const std::string& text) {
    std::string quoted;
    for (const char c : text) {
        if (c == '"' || c == '\\' || c == '$' || c == '`') quoted += '\\';
        quoted += c;
    }
    return quoted;
}

std::string pictureOf(const fs::path& volume) { return volume.stem().string() + ".png"; }

/// Two commands to copy.
std::string loopOver(const FrameSeries& series) {
    const std::string last = series.name(series.numbers.back());
    const FrameSeries variable{inQuotes(series.before), inQuotes(series.after), {}};
    const std::string file = variable.name("${FRAME}");
    return fmt::format(
        "  woodcock render {} --write-scene shot.toml\n"
        "  for FRAME in {}; do woodcock render shot.toml --set \"volume[0].file={}\" -o \"{}\"; "
        "done",
        shellWord(last), shellNumbers(series.numbers), file, pictureOf(file));
}

std::string loopOver(const std::vector<fs::path>& files) {
    if (const auto series = seriesOf(files)) return loopOver(*series);
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

constexpr const char* oneFrame =
    "One call draws one frame. Save a scene from one frame, then draw each frame with it:";

Error sequence(const std::vector<fs::path>& frames) {
    return usageError(
        "{} differ only in a number: they look like frames of a sequence, and would all be drawn "
        "into one picture. {}\n{}\nIf they belong into one picture, give --overlay",
        someOf(frames), oneFrame, loopOver(frames));
}

Error unfilled(const std::string& name, const std::string& pattern) {
    FrameSeries series = seriesOfPattern(name);
    const bool found = !series.numbers.empty();
    if (!found) series.numbers = {"0001", "0002", "0003"};
    return usageError("there is no file '{}': '{}' is not filled in with frame numbers{}. {}\n{}",
                      name, pattern, found ? "" : ", and no file has a number in its place",
                      oneFrame, loopOver(series));
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
        return usageError("{}. It holds {} frames. {}\n{}", is, frames.size(), oneFrame,
                          loopOver(frames));
    return usageError("{}; it holds {} .vdb file{}, such as '{}'", is, volumes.size(),
                      volumes.size() == 1 ? "" : "s", volumes.front().string());
}

}  // namespace

void checkNoFrames(const std::vector<fs::path>& inputs, bool overlay) {
    std::error_code none;
    for (const fs::path& input : inputs) {
        const std::string pattern = framePattern(input.string());
        if (!pattern.empty() && !fs::exists(input, none)) throw unfilled(input.string(), pattern);
        if (fs::is_directory(input, none)) throw folder(input);
    }
    if (overlay) return;
    if (const std::vector<fs::path> frames = framesAmong(inputs); !frames.empty())
        throw sequence(frames);
}

void checkNoPattern(const fs::path& output, const std::string& place) {
    const std::string name = output.string(), pattern = framePattern(name);
    if (pattern.empty()) return;
    const std::size_t at = name.rfind(pattern);
    const std::string before = name.substr(0, at), after = name.substr(at + pattern.size());
    throw usageError(
        "{}'{}': '{}' is not filled in with a frame number, and the file would be called so. One "
        "call draws one frame: name its picture, as in '{}', or in a shell's loop over FRAME, "
        "\"{}\"",
        place.empty() ? "" : place + ": ", name, pattern, before + "0001" + after,
        before + "${FRAME}" + after);
}

}  // namespace woodcock::tool
