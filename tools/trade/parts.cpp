// SPDX-License-Identifier: Apache-2.0
#include "tools/trade/parts.h"

#include <spdlog/spdlog.h>

#include "woodcock/base/error.h"
#include "woodcock/base/version.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool {

void prepareReport(const std::filesystem::path& directory,
                   const std::vector<std::string>& fileNames) {
    if (directory.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error)
        throw usageError("--report: cannot make the directory '{}': {}", directory.string(),
                         error.message());
    for (const std::string& name : fileNames) checkWritable(directory / name);
}

void writeReport(const std::filesystem::path& file, const std::string& text) {
    writeWholeFile(file, text);
    spdlog::info("wrote {}", file.string());
}

// JSON's library writes numbers that are not finite as null.
nlohmann::ordered_json toJson(const Measured& m) { return {{"value", m.value}, {"se", m.se}}; }

nlohmann::ordered_json aboutWoodcock() { return {{"version", version()}}; }

}  // namespace woodcock::tool
