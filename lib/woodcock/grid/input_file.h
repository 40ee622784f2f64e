// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace woodcock::grid {

/// All bytes of a regular file. Errors: Input where it is missing, something else, or cannot be
/// read; Failure where it is larger than half of the memory.
std::string readInput(const std::filesystem::path& file);

}  // namespace woodcock::grid
