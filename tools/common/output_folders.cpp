// SPDX-License-Identifier: Apache-2.0
#include "tools/common/output_folders.h"

#include <spdlog/spdlog.h>

#include "tools/common/frames.h"
#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/scene/description.h"

namespace woodcock::tool {

namespace {

/// `where`: what the message begins with.
void makeFolder(const std::filesystem::path& folder, const std::string& where) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw usageError("{}cannot make the directory '{}': {}", where, folder.string(),
                         error.message());
}

}  // namespace

CLI::Option* addMkdir(CLI::App& command, bool& make) {
    return command.add_flag("--mkdir", make,
                            "Make the folders of the outputs where they are missing");
}

void prepareFolder(const std::filesystem::path& file, bool make, const std::string& place) {
    const std::filesystem::path folder = file.parent_path();
    std::error_code error;
    if (folder.empty() || file == "-" || std::filesystem::exists(folder, error)) return;
    const std::string where = place.empty() ? "" : place + ": ";
    if (!make)
        throw usageError(
            "{}cannot write '{}': there is no directory '{}'; give --mkdir to have it made", where,
            file.string(), folder.string());
    makeFolder(folder, where);
}

void prepareOutput(const std::filesystem::path& file, bool make, const std::string& place) {
    if (file.empty() || file == "-") return;
    checkNoPattern(file, place);
    prepareFolder(file, make, place);
    scene::inPlace(place, [&] { checkWritable(file); });
}

void prepareReport(const std::filesystem::path& folder, const std::vector<std::string>& names) {
    if (folder.empty()) return;
    makeFolder(folder, "--report: ");
    for (const std::string& name : names) checkWritable(folder / name);
}

void writeReport(const std::filesystem::path& folder,
                 const std::vector<std::pair<std::string, std::string>>& files) {
    if (folder.empty()) return;
    std::string written;
    for (const auto& [name, text] : files) {
        writeWholeFile(folder / name, text);
        const bool last = &name == &files.back().first;
        written += (written.empty() ? "" : last ? " and " : ", ") + (folder / name).string();
    }
    spdlog::info("wrote {}", written);
}

}  // namespace woodcock::tool
