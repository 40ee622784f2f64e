// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace woodcock::grid {

/// A format other than VDB, and what a user can do with such a file. All readers use one table of
/// such formats.
struct ForeignFormat {
    std::string what;             ///< "a DICOM file"
    std::string way;              ///< "load the series into 3D Slicer and save it as .nrrd"
    bool readByConvert = false;   ///< `woodcock convert` reads it, as `way` says
    bool knownByContent = false;  ///< known by its bytes; else by its name only
    bool archive = false;         ///< it may hold a format that is read
};

/// Bytes of a file's beginning that tell its format.
constexpr std::size_t foreignBytes = 1024;

/// The format by the file's first bytes (foreignBytes, or all of a shorter file), else by its name.
/// Absent for formats that are not in the table.
std::optional<ForeignFormat> foreignFormat(std::span<const char> beginning,
                                           const std::filesystem::path& name);

/// The same for a file on disk; by its name only, where it is not a regular file that can be read.
std::optional<ForeignFormat> foreignFormat(const std::filesystem::path& file);

}  // namespace woodcock::grid
