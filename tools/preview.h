// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "progress.h"

namespace woodcock::tool {

/// Throws what renderPreview() would throw for the picture's name, at once.
void checkPreview(const std::filesystem::path& picture);

/// Renders a volume file to a small picture, with the view and the light that a render without a
/// scene chooses. Returns false when it was interrupted (what was rendered so far is written).
bool renderPreview(const std::filesystem::path& volume, const std::filesystem::path& picture,
                   ProgressStyle style);

}  // namespace woodcock::tool
