// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "woodcock/base/vec.h"

namespace woodcock {

/// The text of a mesh without its origin, for readers that know floats alone.
struct FarText {
    std::string text;
    Vec3d origin;
};

/// For an OBJ file, or an STL file of text, whose points lie so far from (0, 0, 0) that floats
/// would lose their digits (originFor): its text with the origin taken off in double. Nothing for
/// all others, and for what is written in an unusual way. Errors: as of readInput().
std::optional<FarText> withoutOrigin(const std::filesystem::path& file);

}  // namespace woodcock
