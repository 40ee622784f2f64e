// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace woodcock {

/// What OpenVDB itself makes of a grid: the yardstick of our loading.
struct VdbPeer {
    std::uint64_t activeVoxels = 0;
    std::uint64_t bytes = 0;  ///< of its tree
};

/// Reads a grid by OpenVDB's own file class, all of it at once. Trusts the file: for files that
/// this program has written. Throws Error{Input}.
VdbPeer readByOpenVdb(const std::filesystem::path& file, const std::string& grid);

}  // namespace woodcock
