// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "info_report.h"
#include "print.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/grid_roles.h"

namespace woodcock::tool {

namespace {

constexpr int exitBadInput = 3;

struct InfoOptions {
    std::vector<std::filesystem::path> files;
    std::string grid;
    bool json = false;
};

FileInfo inspectFile(const std::filesystem::path& path, const std::string& gridName) {
    FileInfo info;
    info.path = path;
    try {
        const VdbFile file = listGrids(path);
        info.version = file.version;
        info.warning = file.warning;
        info.bytes = std::filesystem::file_size(path);
        if (!gridName.empty()) {
            info.grids.push_back(inspectGrid(file, findGrid(file, gridName).grid));
        } else {
            for (const GridListing& grid : file.grids)
                info.grids.push_back(inspectGrid(file, grid));
        }
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Input) throw;
        info.error = e.what();
    }
    return info;
}

void report(const FileInfo& file) {
    if (file.error.empty()) printText(infoText(file));
    std::fflush(stdout);  // keeps the order where both streams end on one terminal
    if (!file.error.empty()) spdlog::error("{}", file.error);
    for (const GridInfo& grid : file.grids)
        if (!grid.error.empty()) spdlog::error("{}", grid.error);
}

void runInfo(const InfoOptions& options) {
    std::vector<FileInfo> files;
    for (const std::filesystem::path& path : options.files) {
        files.push_back(inspectFile(path, options.grid));
        if (!options.json) report(files.back());
    }
    if (options.json)
        printData(infoJson(files).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                  "\n");
    const bool sound =
        std::all_of(files.begin(), files.end(), [](const FileInfo& file) { return file.sound(); });
    if (!sound) throw CLI::RuntimeError(exitBadInput);
}

}  // namespace

CLI::App& addInfoCommand(CLI::App& app) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App& command = *app.add_subcommand(
        "info", "Tells what VDB files hold: types, bounds, values, memory, and what looks wrong.");
    command.add_option("INPUT", options->files, "One or more volumes (.vdb, .nvdb)")
        ->required()
        ->type_name("FILE");
    command.add_option("--grid", options->grid, "Only this grid of each file")->type_name("NAME");
    command.add_flag("--json", options->json, "One JSON document for all files, on stdout");
    command.callback([options] { runInfo(*options); });
    return command;
}

}  // namespace woodcock::tool
