// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/common/command.h"
#include "tools/common/exit_codes.h"
#include "tools/common/frames.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/print.h"
#include "tools/common/report_options.h"
#include "tools/info/report.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/grid/grid_roles.h"

namespace woodcock::tool {

namespace {

struct InfoOptions {
    std::vector<std::filesystem::path> files;
    std::string grid;
    std::vector<int> frames;
    ReportOptions reports;
};

}  // namespace

FileInfo inspectFile(const std::filesystem::path& path, const std::string& gridName) {
    FileInfo info;
    info.path = path;
    try {
        const grid::VdbFile file = grid::listGrids(path);
        info.version = file.version;
        info.warning = file.warning;
        info.bytes = std::filesystem::file_size(path);
        if (!gridName.empty()) {
            info.grids.push_back(grid::inspectGrid(file, grid::findGrid(file, gridName).grid));
        } else {
            for (const grid::GridListing& grid : file.grids)
                info.grids.push_back(grid::inspectGrid(file, grid));
        }
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Input) throw;
        info.error = e.what();
    }
    return info;
}

namespace {

void report(const FileInfo& file, bool quiet) {
    if (file.error.empty() && !quiet) printText(infoText(file));
    std::fflush(stdout);  // keeps the order where both streams end on one terminal
    if (!file.error.empty()) spdlog::error("{}", file.error);
    for (const grid::GridInfo& grid : file.grids)
        if (!grid.error.empty()) spdlog::error("{}", grid.error);
}

/// Each frame's; files that hold no place for its number once.
std::vector<std::filesystem::path> filesOf(const InfoOptions& options) {
    if (options.frames.empty()) return options.files;
    checkFrameInputs(options.files);
    std::vector<std::filesystem::path> files;
    for (const int frame : options.frames)
        for (const std::filesystem::path& file : options.files)
            if (frame == options.frames.front() || namesFrame(file.string()))
                files.push_back(inFrame(file, frame));
    return files;
}

void runInfo(const InfoOptions& options) {
    ProgressBar progress(options.reports.start(), "info");
    const bool json = options.reports.json;
    const std::vector<std::filesystem::path> paths = filesOf(options);
    std::vector<FileInfo> files;
    for (const std::filesystem::path& path : paths) {
        files.push_back(inspectFile(path, options.grid));
        if (!json) report(files.back(), options.reports.quiet);
        progress.update(static_cast<double>(files.size()) / static_cast<double>(paths.size()));
    }
    if (json) printJson(infoJson(files));
    const bool sound =
        std::all_of(files.begin(), files.end(), [](const FileInfo& file) { return file.sound(); });
    if (!sound) endWith(options.frames.empty() ? exitBadInput : exitFailed);
}

CLI::App& addTo(CLI::App& app, const std::string&) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App& command = *app.add_subcommand(
        "info", "Show what volume files hold: grids, bounds, values, memory, and what looks wrong");
    command.add_option("INPUT", options->files, "One or more volumes (.vdb, .nvdb)")
        ->required()
        ->type_name("FILE");
    command.add_option("--grid", options->grid, "Only this grid of each file")->type_name("NAME");
    addFrames(command, options->frames,
              "Show these frames, such as 1-48 or 1-48x2,60. Their numbers replace the #### (or "
              "%04d, $F4, <frame04>) in the names of files");
    options->reports.addTo(command, "Print one JSON document for all files, on stdout");
    command.footer(
        examplesText({"woodcock info smoke.vdb", "woodcock info smoke.vdb fire.vdb --json",
                      "woodcock info smoke.####.vdb --frames 1-48"}));
    command.callback([options] { runInfo(*options); });
    return command;
}

}  // namespace

extern const Command infoCommand{&addTo};

}  // namespace woodcock::tool
