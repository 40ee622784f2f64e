// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace woodcock::grid {

struct VdbGrids;

enum class VdbCompression { None, Zip, Blosc };

struct VdbWriteOptions {
    bool half = false;  ///< saves floating-point values as half: relative error 2^-11, up to 65504
    VdbCompression compression = VdbCompression::Blosc;
    std::vector<std::pair<std::string, std::string>> metadata;  ///< of the file
};

/// Writes the grids to a file, whole or not at all. The same grids and options give the same bytes:
/// the file's identifier is made from its contents, where OpenVDB draws it at random.
/// Errors: Failure, with the system's reason, and where OpenVDB was built without the compression.
void writeVdb(const std::filesystem::path& file, const VdbGrids& grids,
              const VdbWriteOptions& options);

}  // namespace woodcock::grid
