// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/common/progress.h"

namespace woodcock::tool {

struct SheetSettings {
    int resolution = 160;  ///< voxels along the longest side of each preset
    int threads = 0;       ///< 0: all
};

/// Throws what writeSheet() would throw for the picture's name, at once.
void checkSheet(const std::filesystem::path& picture);

/// Bakes every preset and renders its preview: one picture of them all, four in a row, in the order
/// of their names. Returns false when it was interrupted; nothing is written then.
bool writeSheet(const std::filesystem::path& picture, const SheetSettings& settings,
                ProgressStyle style);

}  // namespace woodcock::tool
