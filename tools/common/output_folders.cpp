// SPDX-License-Identifier: Apache-2.0
#include "tools/common/output_folders.h"

#include "woodcock/base/error.h"

namespace woodcock::tool {

CLI::Option* addMkdir(CLI::App& command, bool& make) {
    return command.add_flag("--mkdir", make, "Make the folders of outputs that are missing");
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
    std::filesystem::create_directories(folder, error);
    if (error)
        throw usageError("{}cannot make the directory '{}': {}", where, folder.string(),
                         error.message());
}

}  // namespace woodcock::tool
