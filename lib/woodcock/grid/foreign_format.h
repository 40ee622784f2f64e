// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace woodcock {

/// A format that is no VDB, and the way on for those who have such a file. The one table of such
/// formats serves all that reads files.
struct ForeignFormat {
    std::string what;             ///< "a DICOM file"
    std::string way;              ///< "load the series into 3D Slicer and save it as .nrrd"
    bool readByConvert = false;   ///< `woodcock convert` reads it, and the way says so
    bool knownByContent = false;  ///< by its bytes, else by its name alone
    bool archive = false;         ///< which may hold a format that is read
};

/// Bytes of a file's beginning that tell its format.
constexpr std::size_t foreignBytes = 1024;

/// By the file's first bytes (foreignBytes, or all of a shorter file), and where these tell
/// nothing by its name. Nothing for formats that are not in the table.
std::optional<ForeignFormat> foreignFormat(std::span<const char> beginning,
                                           const std::filesystem::path& name);

/// The same of a file; by its name alone where it is no regular file that can be read.
std::optional<ForeignFormat> foreignFormat(const std::filesystem::path& file);

}  // namespace woodcock
