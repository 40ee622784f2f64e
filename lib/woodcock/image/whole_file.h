// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

namespace woodcock {

/// Writes `file` whole or not at all: into a temporary file beside it, which is then renamed. On
/// failure the temporary is removed, a former `file` stays as it was, and Error{Failure} names the
/// file and the system's reason.
void writeWholeFile(const std::filesystem::path& file, std::span<const unsigned char> bytes);

/// Throws Error{Usage} where writeWholeFile(file) would certainly fail: there is no such directory,
/// it cannot be written, or `file` is a directory itself. Leaves no trace.
void checkWritable(const std::filesystem::path& file);

}  // namespace woodcock
