// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace woodcock::tool {

// One call draws one frame. What follows finds calls that expect more, and says how it is done.

/// Throws Error{Usage} on inputs that are frames of a sequence (names that differ in numbers alone;
/// not with `overlay`), patterns that stand for frames, or folders.
void checkNoFrames(const std::vector<std::filesystem::path>& inputs, bool overlay);

/// Throws Error{Usage} on an output whose name holds a pattern for frames, which would stay in the
/// file's name. `place`: where it was given; may be empty.
void checkNoPattern(const std::filesystem::path& output, const std::string& place);

}  // namespace woodcock::tool
