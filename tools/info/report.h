// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "woodcock/grid/grid_info.h"

namespace woodcock::tool {

struct FileInfo {
    std::filesystem::path path;
    std::string error;  ///< why the file cannot be used; empty when it can
    std::string version;
    std::string warning;  ///< of a format newer than any that is known; usually empty
    std::uintmax_t bytes = 0;
    std::vector<grid::GridInfo> grids;

    bool sound() const;  ///< the file and all of its voxels could be read
};

/// What a file holds; only the grid of this name unless it is empty. What is wrong with the file is
/// its `error`.
FileInfo inspectFile(const std::filesystem::path& path, const std::string& gridName);

std::string infoText(const FileInfo& file);  ///< for people; without the error
nlohmann::ordered_json infoJson(const std::vector<FileInfo>& files);

}  // namespace woodcock::tool
